#include <nlohmann/json.hpp>

#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// A cube from -1 to 1 of six squares, its corners moved by (x, 0, 0) and scaled.
std::string cube_off(double x = 0.0, double scale = 1.0, bool lid = true) {
  std::ostringstream text;
  text << "OFF\n8 " << (lid ? 6 : 5) << " 0\n";
  for (int i = 0; i < 8; ++i)
    text << x + scale * (i & 1 ? 1 : -1) << ' ' << scale * (i & 2 ? 1 : -1) << ' ' << scale * (i & 4 ? 1 : -1)
         << '\n';
  text << "4 0 2 3 1\n4 0 1 5 4\n4 1 3 7 5\n4 3 2 6 7\n4 2 0 4 6\n";
  if (lid) text << "4 4 5 7 6\n";
  return text.str();
}

constexpr const char* kQueries = R"({"version": 1,  // comments are allowed
  "points": [[0, 0, 0], [1, 0.5, 0.25], [3, 0, 0]],
  "balls": [{"centre": [0, 0, 0], "radius": 0.5}, {"centre": [2, 0, 0], "radius": 1},
            {"centre": [2, 0, 0], "radius": 0.999}, {"centre": [2, 0, 0], "radius": 1.5}],
  "segments": [[[0, 0.25, 0.5], [2, 0.25, 0.5]], [[2, 2, 2], [3, 3, 3]]],
  "triangles": [[[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]], [[1, 0, 0], [2, 0, 0], [2, 1, 0]]]})";

Json answers(const Folder& folder, const std::string& arguments, int code = 0) {
  const Outcome outcome = folder.run("collide " + arguments + " --json");
  EXPECT_EQ(outcome.code, code) << outcome.err;
  return Json::parse(outcome.out);
}

std::vector<std::string> column(const Json& found, const char* key) {
  std::vector<std::string> out;
  for (const Json& query : found.at("queries")) out.push_back(query.at(key));
  return out;
}

using Words = std::vector<std::string>;

TEST(Collide, SaysWhatMeetsAMesh) {
  const Folder folder;
  folder.write("cube.off", cube_off());
  folder.write("q.json", kQueries);
  const Json found = answers(folder, "cube.off q.json");
  EXPECT_EQ(found.at("triangles"), 12);
  EXPECT_TRUE(found.at("closed"));
  EXPECT_EQ(column(found, "query"),
            (Words{"points/0", "points/1", "points/2", "balls/0", "balls/1", "balls/2", "balls/3",
                   "segments/0", "segments/1", "triangles/0", "triangles/1"}));
  EXPECT_EQ(column(found, "answer"), (Words{"hit", "touching", "free", "hit", "touching", "free", "hit",
                                            "hit", "free", "free", "touching"}));
  EXPECT_EQ(column(found, "surface"), (Words{"free", "touching", "free", "free", "touching", "free", "hit",
                                             "hit", "free", "free", "touching"}));
  EXPECT_EQ(column(found, "side"), (Words{"inside", "on", "outside", "inside", "on", "outside", "on", "on",
                                          "outside", "inside", "on"}));
  const Json& far = found.at("queries")[2];
  EXPECT_NEAR(far.at("distance").at("upper").get<double>(), 2.0, 1e-14);
  EXPECT_LE(far.at("distance").at("lower"), 2.0);
  EXPECT_EQ(far.at("nearest_point"), Json::parse("[1.0, 0.0, 0.0]"));
  EXPECT_EQ(far.at("nearest_face"), 2);
  const Json& through = found.at("queries")[7];
  ASSERT_EQ(through.at("triangles").size(), 1U);
  EXPECT_EQ(through.at("triangles")[0].at("face"), 2);
  EXPECT_EQ(through.at("triangles")[0].at("relation"), "hit");
}

TEST(Collide, PrintsATableAndWritesTheSameToAFile) {
  const Folder folder;
  folder.write("cube.off", cube_off());
  folder.write("q.json", kQueries);
  const Outcome outcome = folder.run("collide cube.off q.json --out found.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("12 triangles, closed"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("balls/1        touching            touching"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(Json::parse(bytes_of(folder / "found.json")), answers(folder, "cube.off q.json"));
}

TEST(Collide, SaysThatAnOpenMeshHasNoInside) {
  const Folder folder;
  folder.write("open.off", cube_off(0, 1, false));
  folder.write("q.json", R"({"version": 1, "points": [[0, 0, 0], [1, 0, 0]],
                             "balls": [{"centre": [0, 0, 0], "radius": 1.25}]})");
  const Outcome outcome = folder.run("collide open.off q.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("1 undecidable: the surface is open"), std::string::npos) << outcome.err;
  const Json found = answers(folder, "open.off q.json", 1);
  EXPECT_FALSE(found.at("closed"));
  EXPECT_EQ(column(found, "answer"), (Words{"undecidable", "touching", "hit"}));
  EXPECT_EQ(found.at("queries")[0].at("reason"), "open");
  EXPECT_NEAR(found.at("queries")[0].at("winding").get<double>(), 5.0 / 6, 1e-14);
}

TEST(Collide, HoldsTwoMeshesAgainstEachOther) {
  const Folder folder;
  folder.write("cube.off", cube_off());
  folder.write("within.off", cube_off(0, 0.5));
  folder.write("beside.off", cube_off(2.5, 1));
  folder.write("across.off", cube_off(0.5, 0.9));
  folder.write("against.off", cube_off(2, 1));
  const Json within = answers(folder, "cube.off within.off");
  EXPECT_EQ(within.at("answer"), "free");
  EXPECT_NEAR(within.at("distance").at("upper").get<double>(), 0.5, 1e-14);
  EXPECT_EQ(within.at("parts_of_other"), Json::parse(R"({"inside": 1, "outside": 0, "undecidable": 0})"));
  EXPECT_EQ(within.at("parts_of_mesh"), Json::parse(R"({"inside": 0, "outside": 1, "undecidable": 0})"));
  EXPECT_EQ(answers(folder, "within.off cube.off").at("parts_of_mesh").at("inside"), 1);
  const Json beside = answers(folder, "cube.off beside.off");
  EXPECT_NEAR(beside.at("distance").at("lower").get<double>(), 0.5, 1e-14);
  EXPECT_EQ(beside.at("parts_of_other").at("outside"), 1);
  EXPECT_EQ(answers(folder, "cube.off across.off").at("answer"), "hit");
  const Json against = answers(folder, "cube.off against.off");
  EXPECT_EQ(against.at("answer"), "touching");
  EXPECT_GT(against.at("pairs").size(), 4U);
  EXPECT_EQ(against.at("distance").at("upper"), 0.0);
  EXPECT_TRUE(against.at("parts_of_other").is_null());
}

constexpr const char* kMast =
    R"({"version": 1, "orientation": [1, 0, 0], "points": [[0, 0, 0], [0, 0.4, 0], [0, 0.7, 0], [0, 1, 0]]})";
constexpr const char* kBentMast =
    R"({"version": 1, "orientation": [0, 0, 1], "points": [[0, 0, 0], [0, 0.4, 0], [0.3, 0.6, 0], [0.6, 0.5, 0]]})";

std::string many_queries() {
  Json out{{"version", 1}};
  for (int i = 0; i < 40; ++i) {
    const double x = 0.02 * i, y = 0.6 - 0.003 * i * (i % 7), z = 0.01 * (i % 5);
    out["points"].push_back({x, y, z});
    out["balls"].push_back({{"centre", {x, y, z}}, {"radius", 0.01 + 0.002 * i}});
    out["segments"].push_back({{x, y, z}, {z, x, y}});
    out["triangles"].push_back({{x, y, z}, {z, x, y}, {y, z, x}});
  }
  return out.dump();
}

/// Those of an open mesh are sums that are rounded in another order.
Json without_windings(const Json& found) {
  Json queries = found.at("queries");
  for (Json& query : queries) query.erase("winding");
  return queries;
}

/// The mesh of `deform`, written in full precision, gives the same answers as the mesh that is deformed where
/// it is touched.
TEST(Collide, DeformsWhatDeformDeforms) {
  const Folder folder;
  folder.write("tube.off", tube_off(40));
  folder.write("axis.json", kMast);
  folder.write("pose.json", kBentMast);
  folder.write("q.json", many_queries());
  ASSERT_EQ(folder.run("deform tube.off --axis axis.json --pose pose.json --out posed.off").code, 0);
  const Json lazy = answers(folder, "tube.off q.json --axis axis.json --pose pose.json", 1);
  const Json whole = answers(folder, "posed.off q.json", 1);
  EXPECT_TRUE(without_windings(lazy) == without_windings(whole));
  EXPECT_GT(lazy.at("cells_deformed"), 0);
  EXPECT_TRUE(whole.at("cells").is_null());
  const Json rest = answers(folder, "tube.off q.json --axis axis.json", 1);
  EXPECT_FALSE(without_windings(rest) == without_windings(whole));
}

std::string posed_scene(double reach) {
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"].erase(1);
  scene["forces"] = Json::array({scene["forces"][0]});
  scene["curve_pairs"][0]["reach"] = reach;
  return scene.dump();
}

/// The scene's masses, of which the upper ones lean over.
constexpr const char* kLeaning = R"({"version": 1, "orientation": [1, 0, 0], "points":
  [[0, 0, 0], [0, 0.2, 0], [0, 0.4, 0], [0, 0.6, 0.05], [0, 0.8, 0.2], [0, 0.9, 0.5]]})";

TEST(Collide, PosesASceneByItsMasses) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("scene.json", posed_scene(1.0));
  folder.write("pose.json", kLeaning);
  folder.write("q.json", R"({"version": 1, "segments": [[[-1, 0.95, 0], [1, 0.95, 0]],
                                                        [[-1, 0.85, 0.5], [1, 0.85, 0.5]]]})");
  EXPECT_EQ(column(answers(folder, "scene.json q.json"), "answer"), (Words{"hit", "free"}));
  const Json posed = answers(folder, "scene.json q.json --pose pose.json");
  EXPECT_EQ(column(posed, "answer"), (Words{"free", "hit"}));
  EXPECT_EQ(posed.at("out_of_reach"), 0);
}

/// Corners of the tube, 0.141 from the axis, are out of reach: all of it stays where its file has it, to the
/// last bit.
TEST(Collide, LeavesWhatIsOutOfReachWhereItIs) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("scene.json", posed_scene(0.14));
  folder.write("pose.json", kLeaning);
  folder.write("q.json", R"({"version": 1, "points": [[0.1, 1, 0.1], [-0.1, 0.875, 0.1]]})");
  const Json found = answers(folder, "scene.json q.json --pose pose.json");
  EXPECT_EQ(found.at("out_of_reach"), 36);
  EXPECT_EQ(column(found, "answer"), (Words{"touching", "touching"}));
  folder.write("scene.json", posed_scene(1.0));
  EXPECT_EQ(column(answers(folder, "scene.json q.json --pose pose.json", 1), "answer"),
            (Words{"undecidable", "undecidable"}));
}

struct Refusal {
  const char* queries;
  const char* place;
  const char* says;
};

const Refusal kRefusals[] = {
    {"", "q.json:1:", "JSON"},
    {"[1]", "q.json#:", "expected"},
    {R"({"points": [[0, 0, 0]]})", "q.json#:", "'version' is missing"},
    {R"({"version": 1})", "q.json#:", "at least one of points"},
    {R"({"version": 1, "points": []})", "q.json#:", "at least one of points"},
    {R"({"version": 1, "points": [[0, 0]]})", "q.json#/points/0:", "three finite numbers"},
    {R"({"version": 1, "points": [[0, 0, NaN]]})", "q.json:1:", "expected"},
    {R"({"version": 1, "points": [[0, 0, 1e999]]})", "q.json:1:", "expected"},
    {R"({"version": 1, "points": [[0, 0, 0], [0, "a", 0]]})", "q.json#/points/1/1:", "wrong type"},
    {R"({"version": 1, "balls": [{"centre": [0, 0, 0], "radius": 0}]})",
     "q.json#/balls/0/radius:", "a positive number"},
    {R"({"version": 1, "balls": [{"centre": [0, 0, 0], "radius": -1}]})",
     "q.json#/balls/0/radius:", "a positive number"},
    {R"({"version": 1, "balls": [{"centre": [0, 0, 0]}]})", "q.json#/balls/0:", "'radius' is missing"},
    {R"({"version": 1, "segments": [[[0, 0, 0]]]})", "q.json#/segments/0:", "two ends"},
    {R"({"version": 1, "triangles": [[[0, 0, 0], [0, 0, 1]]]})", "q.json#/triangles/0:", "three corners"},
    {R"({"version": 1, "spheres": []})", "q.json#/spheres:", "unknown key"},
};

void expect_refused(const Folder& folder, const std::string& arguments, const std::string& place,
                    const std::string& says) {
  const Outcome outcome = folder.run("collide " + arguments + " --out out");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(place), std::string::npos) << outcome.err << "lacks " << place;
  EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err << "lacks " << says;
  EXPECT_FALSE(std::filesystem::exists(folder / "out")) << arguments;
}

TEST(Collide, RefusesQueriesWithThePlaceAndTheReason) {
  const Folder folder;
  folder.write("cube.off", cube_off());
  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(refusal.queries);
    folder.write("q.json", refusal.queries);
    expect_refused(folder, "cube.off q.json", refusal.place, refusal.says);
  }
}

TEST(Collide, RefusesOtherFilesToo) {
  const Folder folder;
  folder.write("cube.off", cube_off());
  folder.write("tube.off", tube_off());
  folder.write("q.json", kQueries);
  folder.write("none.off", "OFF\n1 0 0\n0 0 0\n");
  folder.write("nan.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n");
  folder.write("cut.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
  folder.write("axis.json", kMast);
  Json scene = Json::parse(full_scene());
  scene.erase("mesh");
  scene.erase("bound_to");
  folder.write("bare.json", scene.dump());
  folder.write("scene.json", posed_scene(1.0));
  for (const char* order : {"none.off q.json", "cube.off none.off"})
    expect_refused(folder, order, "none.off:", "at least one face");
  expect_refused(folder, "nan.off q.json", "nan.off:4", "expected");
  expect_refused(folder, "cube.off cut.off", "cut.off:", "expected");
  expect_refused(folder, "missing.off q.json", "missing.off", "No such file");
  expect_refused(folder, "cube.off missing.json", "missing.json", "No such file");
  expect_refused(folder, "bare.json q.json", "bare.json#:", "'mesh' is missing");
  expect_refused(folder, "cube.off q.json --pose axis.json", "--pose:", "without --axis");
  expect_refused(folder, "scene.json q.json --axis axis.json", "--axis:", "with a scene");
  expect_refused(folder, "scene.json q.json --pose axis.json", "axis.json#:", "chain of its 6 masses");
  folder.write("two.json", R"({"version": 1, "curves": [)" + std::string(kMast).replace(0, 14, "{") + "," +
                               std::string(kMast).replace(0, 14, "{") + "]}");
  expect_refused(folder, "scene.json q.json --pose two.json", "two.json#:", "2 curve-pairs");
}

}  // namespace
}  // namespace tendril::test
