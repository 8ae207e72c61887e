#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include <tendril/bind/import.h>

#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kAxis = R"({"version": 1, "orientation": [0, 0, 1], "points":
  [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2.5, 0.5, 0], [2, 1, 0], [1, 1, 0], [0, 1, 0]]})";
constexpr const char* kPose = R"({"version": 1, "orientation": [0, 0, 1], "points":
  [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2.7, 0, 0], [3.4, 0, 0], [4.4, 0, 0], [5.4, 0, 0]]})";

/// A sheet between and around the legs of the axis, which is a U.
std::string sheet_off() {
  constexpr int kAlong = 24, kAcross = 12;
  std::ostringstream text;
  text << "OFF\n" << (kAlong + 1) * (kAcross + 1) << ' ' << kAlong * kAcross << " 0\n";
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k <= kAcross; ++k) text << 0.1 * i << ' ' << -0.3 + 1.6 * k / kAcross << " 0.1\n";
  for (int i = 0; i < kAlong; ++i)
    for (int k = 0; k < kAcross; ++k) {
      const int a = i * (kAcross + 1) + k, b = a + kAcross + 1;
      text << "4 " << a << ' ' << b << ' ' << b + 1 << ' ' << a + 1 << '\n';
    }
  return text.str();
}

TEST(Bind, ShowsTheTearOfNearestBindingAndNoneOfContinuous) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  folder.write("pose.json", kPose);
  const std::string command = "bind sheet.off --axis axis.json --pose pose.json --refinements 1 --json";
  const Outcome nearest = folder.run(command + " --nearest");
  EXPECT_EQ(nearest.code, 1);
  const auto torn = Json::parse(nearest.out).at("judge");
  EXPECT_EQ(torn.at("verdict"), "tear");
  EXPECT_NEAR(torn.at("growth_of_max").get<double>(), 2.0, 0.1);
  const Outcome continuous = folder.run(command);
  const Json smooth = Json::parse(continuous.out);
  EXPECT_NE(smooth.at("judge").at("verdict"), "tear");
  EXPECT_GT(smooth.at("binding").at("ambiguous").at("count"), 0U);
  EXPECT_LT(smooth.at("binding").at("ambiguous").at("count"), 25U * 13U);
}

/// Lists that may be as long as the mesh are cut, and counted.
TEST(Bind, ListsAHundredOfWhatIsManyAndSaysHowMany) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  folder.write("pose.json", kPose);
  const Outcome outcome = folder.run("bind sheet.off --axis axis.json --pose pose.json --nearest --json");
  const Json out = Json::parse(outcome.out);
  const Json& gated = out.at("binding").at("past_focus");
  EXPECT_EQ(gated.at("ids").size(), std::min<std::size_t>(100, gated.at("count").get<std::size_t>()));
  const Json& judge = out.at("judge");
  EXPECT_GT(judge.at("torn"), 0);
  EXPECT_EQ(judge.at("tears").size(), std::min<std::size_t>(100, judge.at("torn").get<std::size_t>()));
  ASSERT_GT(judge.at("distortion").at("zones").size(), 0U);
  bool cut = false;
  for (const Json& zone : judge.at("distortion").at("zones")) {
    const Json& faces = zone.at("faces");
    EXPECT_EQ(faces.at("ids").size(), std::min<std::size_t>(100, faces.at("count").get<std::size_t>()));
    cut |= faces.at("count") > 100;
  }
  EXPECT_TRUE(cut);
  EXPECT_NE(outcome.err.find("tendril: judging binds "), std::string::npos) << outcome.err;
  EXPECT_LT(outcome.out.size(), 200000U);
}

/// A tetrahedron on the sheet between the legs is nearer to one of them.
TEST(Bind, SaysWhichPartsFollowWhichCurve) {
  const Folder folder;
  std::string text = sheet_off();
  const std::string head = "OFF\n325 288 0\n";
  ASSERT_TRUE(text.starts_with(head));
  const std::size_t faces = text.find("\n4 ") + 1;
  text = "OFF\n329 292 0\n" + text.substr(head.size(), faces - head.size()) +
         "1 0.8 0.1\n1.02 0.8 0.1\n1 0.82 0.1\n1 0.8 0.12\n" + text.substr(faces) +
         "3 325 327 326\n3 325 326 328\n3 326 327 328\n3 327 325 328\n";
  folder.write("sheet.off", text);
  folder.write("tree.json", R"({"version": 1, "curves": [
    {"name": "lower", "orientation": [0, 0, 1], "points": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2.5, 0, 0]]},
    {"name": "upper", "orientation": [0, 0, 1], "points": [[0, 1, 0], [1, 1, 0], [2, 1, 0], [2.5, 1, 0]]}]})");
  const Json loose =
      Json::parse(folder.run("bind sheet.off --axis tree.json --json").out).at("binding").at("loose");
  ASSERT_EQ(loose.size(), 1U) << loose;
  EXPECT_EQ(loose[0].at("first"), 325);
  EXPECT_EQ(loose[0].at("points"), 4);
  EXPECT_EQ(loose[0].at("curve_pair"), "upper");
  EXPECT_NEAR(loose[0].at("parameter").get<double>(), 0.4, 0.05);
  const std::string told = folder.run("bind sheet.off --axis tree.json").out;
  EXPECT_NE(told.find("a part of 4 point(s), from point 325 on, follows upper whole"), std::string::npos)
      << told;
}

TEST(Bind, DrawsAndReportsWithoutAPose) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  const Outcome outcome = folder.run("bind sheet.off --axis axis.json --refinements 1 --picture sheet.png");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(bytes_of(folder / "sheet.png").substr(1, 3), "PNG");
}

TEST(Bind, RefusesAPoseThatDoesNotFit) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  folder.write("axis.json", kAxis);
  folder.write(
      "other.json",
      R"({"version": 1, "orientation": [0, 0, 1], "points": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]})");
  EXPECT_EQ(folder.run("bind sheet.off --axis axis.json --pose other.json").code, 2);
  EXPECT_EQ(folder.run("bind sheet.off --axis axis.json --axis axis.json --pose axis.json").code, 2);
  EXPECT_EQ(folder.run("bind sheet.off --axis axis.json --band 3").code, 2);
}

const std::string kCases = std::string(TENDRIL_SOURCE_DIR) + "/tests/data/cases/";

/// Refused with both nodes named, whichever command binds to it, and nothing written.
TEST(Bind, RefusesAxesAndPosesWhoseFramesJump) {
  const Folder folder;
  folder.write("sheet.off", sheet_off());
  const std::string flip = kCases + "orientation_flip/", none = kCases + "pose_without_frame/";
  struct {
    std::string rest, pose, says;
  } const cases[] = {
      {flip + "r_flip_dir12.json", flip + "p_flip_dir12.json", "nodes 5 and 6"},
      {none + "r_fold.json", none + "p_fold.json", "folds back"},
      {none + "r_ori_on_helix.json", none + "p_ori_on_helix.json", "no frame between nodes 0 and 1"},
      {flip + "axis_bad.json", flip + "axis_bad.json", "nodes 5 and 6"}};
  for (const auto& c : cases) {
    const std::string axes = " sheet.off --axis " + c.rest + " --pose " + c.pose;
    for (const std::string& command :
         {"deform" + axes + " --out o.ply", "bind" + axes, "deform" + axes + " --out o.ply --equal-length"}) {
      const Outcome outcome = folder.run(command);
      EXPECT_EQ(outcome.code, 2) << command;
      EXPECT_NE(outcome.err.find(c.says), std::string::npos) << outcome.err << command;
      EXPECT_FALSE(std::filesystem::exists(folder / "o.ply"));
    }
  }
  const Outcome run = folder.run("run " + flip + "scene_bad.json --out out");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("#/curve_pairs/0/orientation: orientation between nodes 5 and 6"), std::string::npos)
      << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

/// Orientation points that turn by more than 90 degrees from node to node are refused where a mesh follows.
TEST(Bind, RefusesSceneMeshesOnFramesThatJumpAtRest) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json scene = Json::parse(full_scene());
  scene["bound_to"] = "chain";
  folder.write("good.json", scene.dump());
  scene["curve_pairs"][1]["orientation"][2] = {1.4, 1, -1};
  folder.write("bad.json", scene.dump());
  EXPECT_EQ(folder.run("run good.json --out good --no-pictures").code, 0);
  const Outcome outcome = folder.run("run bad.json --out out --no-pictures");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("#/curve_pairs/1"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("nodes 1 and 2"), std::string::npos) << outcome.err;
}

constexpr const char* kTree = R"({"version": 1, "curves": [
  {"name": "stem", "points": [[0,0,0],[0,1,0],[0,2,0],[0,3,0],[0,4,0]], "orientation": [1, 0, 0]},
  {"name": "arm", "joint": {"curve_pair": "stem", "node": 4}, "orientation": [0, 1, 0],
   "points": [[0,4,0],[0,4,1],[0,4,2],[0,4,3]]}]})";

std::vector<Vec3> points_of(const Json& curve) {
  std::vector<Vec3> out;
  for (const Json& p : curve.at("points"))
    out.emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
  return out;
}

TEST(Pose, BendsACurveAndTakesAlongWhatIsJoined) {
  const Folder folder;
  folder.write("tree.json", kTree);
  const Outcome outcome = folder.run("pose tree.json --bend stem:90 --out bent.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json bent = Json::parse(bytes_of(folder / "bent.json"));
  const std::vector<Vec3> stem = points_of(bent["curves"][0]), arm = points_of(bent["curves"][1]);
  // Chords of a quarter of a circle, towards the orientation's side, by a quarter of the angle each.
  const double eighth = std::numbers::pi / 16.0, radius = 0.5 / std::sin(eighth);
  for (std::size_t i = 0; i < 5; ++i) {
    const double angle = 2.0 * eighth * static_cast<double>(i);
    EXPECT_LT((stem[i] - radius * Vec3(1.0 - std::cos(angle), std::sin(angle), 0)).norm(), 1e-14);
  }
  for (std::size_t i = 1; i < 5; ++i) EXPECT_NEAR((stem[i] - stem[i - 1]).norm(), 1.0, 1e-14);
  EXPECT_LT((arm[0] - stem[4]).norm(), 1e-14);
  EXPECT_LT((arm[3] - arm[0] - Vec3(0, 0, 3)).norm(), 1e-14);  // about which the stem is bent
  EXPECT_EQ(bent["curves"][1]["joint"]["node"], 4);
  EXPECT_EQ(folder.run("pose tree.json --out same.json").code, 0);
  const Json same = Json::parse(bytes_of(folder / "same.json"));
  EXPECT_LT((points_of(same["curves"][1])[3] - Vec3(0, 4, 3)).norm(), 1e-15);
}

TEST(Pose, TwistsACurveAndTakesAlongWhatIsJoined) {
  const Folder folder;
  folder.write("tree.json", kTree);
  ASSERT_EQ(folder.run("pose tree.json --twist stem:90 --bend arm:30 --bend arm:-30 --out t.json").code, 0);
  const Json twisted = Json::parse(bytes_of(folder / "t.json"));
  const std::vector<Vec3> stem = points_of(twisted["curves"][0]), arm = points_of(twisted["curves"][1]);
  EXPECT_LT((stem[4] - Vec3(0, 4, 0)).norm(), 1e-14);
  EXPECT_LT((arm[3] - arm[0] - Vec3(3, 0, 0)).norm(), 1e-14);  // about y from z to x
  const Json q = twisted["curves"][0]["orientation"];
  EXPECT_GT(q[0][0].get<double>(), 0.1);
  EXPECT_LT(q[4][2].get<double>(), -0.1);
  folder.write("tube.off", tube_off());
  EXPECT_EQ(folder.run("deform tube.off --axis tree.json --pose t.json --out t.ply").code, 0);
}

TEST(Pose, RefusesWhatItCannotDo) {
  const Folder folder;
  folder.write("tree.json", kTree);
  const std::pair<const char*, const char*> cases[] = {{"--bend leg:30", "stem, arm"},
                                                       {"--bend stem", "NAME:DEGREES"},
                                                       {"--bend stem:", "NAME:DEGREES"},
                                                       {"--bend stem:3x", "NAME:DEGREES"},
                                                       {"--twist stem:720", "between nodes 0 and 1"}};
  for (const auto& [option, says] : cases) {
    const Outcome outcome = folder.run(std::string("pose tree.json --out o.json ") + option);
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "o.json"));
  }
}

TEST(Render, DrawsTreesWithTheirNames) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("tree.json", kTree);
  std::string other = kTree;
  other.replace(other.find("\"arm\""), 5, "\"leg\"");
  folder.write("other.json", other);
  for (const std::string name : {"tree", "other"})
    ASSERT_EQ(folder.run("render tube.off --axis " + name + ".json --out " + name + ".png --samples 1").code,
              0);
  EXPECT_NE(bytes_of(folder / "tree.png"), bytes_of(folder / "other.png"));
}

/// Bent so that the sheet beside it folds over: what `deform` writes, it says.
TEST(Deform, SaysWhatAPoseSpoilsAndTurnsNormals) {
  const Folder folder;
  std::ostringstream text;
  text << "NOFF\n22 10 0\n";
  for (int i = 0; i <= 10; ++i) text << 0.4 * i << " -1 0 0 0 1\n" << 0.4 * i << " 1 0 0 0 1\n";
  for (int i = 0; i < 10; ++i)
    text << "4 " << 2 * i << ' ' << 2 * i + 2 << ' ' << 2 * i + 3 << ' ' << 2 * i + 1 << '\n';
  folder.write("strip.off", text.str());
  folder.write("rest.json", R"({"version": 1, "orientation": [0, 1, 0],
    "points": [[0,0,0],[1,0,0],[2,0,0],[3,0,0],[4,0,0]]})");
  ASSERT_EQ(folder.run("pose rest.json --twist 0:90 --out twisted.json").code, 0);
  ASSERT_EQ(folder.run("pose rest.json --bend 0:240 --out curled.json").code, 0);
  const Outcome twisted =
      folder.run("deform strip.off --axis rest.json --pose twisted.json --out t.off --json");
  ASSERT_EQ(twisted.code, 0) << twisted.err;
  EXPECT_EQ(twisted.err, "");
  EXPECT_EQ(Json::parse(twisted.out).at("distortion").at("folded"), 0);
  const bind::PolygonMesh mesh = bind::read_mesh(folder / "t.off");
  ASSERT_EQ(mesh.point_normals.size(), 22U);
  EXPECT_GT(mesh.point_normals.front().z(), 0.9);
  EXPECT_LT(mesh.point_normals.back().y(), -0.9);
  const Outcome curled =
      folder.run("deform strip.off --axis rest.json --pose curled.json --out c.off --json");
  ASSERT_EQ(curled.code, 0) << curled.err;
  EXPECT_GT(Json::parse(curled.out).at("distortion").at("folded"), 0);
  EXPECT_NE(curled.err.find("the pose spoils"), std::string::npos) << curled.err;
  const Outcome judged =
      folder.run("bind strip.off --axis rest.json --pose curled.json --refinements 1 --json");
  EXPECT_EQ(judged.code, 1);
  EXPECT_EQ(Json::parse(judged.out).at("judge").at("verdict"), "crumpled");
}

/// A bar of one long quad a side cuts across the bend of its axis: half its volume goes, which is said. So
/// is an axis that is elsewhere.
TEST(Deform, SaysWhereAMeshIsTooCoarseOrElsewhere) {
  const Folder folder;
  folder.write("bar.off",
               "OFF\n8 6 0\n0 -1 -1\n20 -1 -1\n20 1 -1\n0 1 -1\n0 -1 1\n20 -1 1\n20 1 1\n0 1 1\n"
               "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  std::ostringstream axis;
  axis << R"({"version": 1, "orientation": [0, 1, 0], "points": [)";
  for (int i = 0; i <= 20; ++i) axis << (i > 0 ? "," : "") << '[' << i << ",0,0]";
  axis << "]}";
  folder.write("axis.json", axis.str());
  folder.write(
      "far.json",
      R"({"version": 1, "orientation": [0, 1, 0], "points": [[50,0,0],[60,0,0],[70,0,0],[80,0,0]]})");
  ASSERT_EQ(folder.run("pose axis.json --bend 0:30 --out a.json").code, 0);
  ASSERT_EQ(folder.run("pose axis.json --bend 30 --out same.json").code, 0);  // of the one curve there is
  EXPECT_EQ(bytes_of(folder / "same.json"), bytes_of(folder / "a.json"));
  ASSERT_EQ(folder.run("pose axis.json --bend 0:120 --out b.json").code, 0);
  const Outcome gentle = folder.run("deform bar.off --axis axis.json --pose a.json --out a.off");
  EXPECT_EQ(gentle.code, 0);
  EXPECT_EQ(gentle.err.find("the volume"), std::string::npos) << gentle.err;
  const Outcome sharp = folder.run("deform bar.off --axis axis.json --pose b.json --out b.off");
  EXPECT_EQ(sharp.code, 0);
  EXPECT_NE(sharp.err.find("the volume went to 0."), std::string::npos) << sharp.err;
  const Outcome elsewhere = folder.run("deform bar.off --axis far.json --pose far.json --out c.off");
  EXPECT_EQ(elsewhere.code, 0);
  EXPECT_NE(elsewhere.err.find("all of it is beyond the ends"), std::string::npos) << elsewhere.err;
  for (const char* arguments :
       {"deform bar.off --axis axis.json --pose a.json --nearest --band 0.3 --out d.off",
        "repair bar.off --keep-points --merge-distance 1e-6 --out d.off",
        "rig bar.off --axis axis.json --spacing 1 --out d.json",
        "rig bar.off --axis axis.json --out d.png --picture ./d.png"}) {
    const Outcome refused = folder.run(arguments);
    EXPECT_EQ(refused.code, 2) << arguments << refused.out;
    EXPECT_FALSE(refused.err.empty());
  }
}

}  // namespace
}  // namespace tendril::test
