#include "runner/program.h"

#include <nlohmann/json.hpp>

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// A scene or curve with one value replaced, added or (value null pointer) taken away.
struct Edit {
  const char* pointer;
  const char* value;  ///< JSON text
  const char* place;  ///< expected pointer in the message
  const char* says;   ///< expected words of the message
};

std::string edited(const std::string& base, const Edit& edit) {
  Json json = Json::parse(base);
  const Json::json_pointer at(edit.pointer);
  if (edit.value != nullptr) {
    json[at] = Json::parse(edit.value);
  } else {
    json.at(at.parent_pointer()).erase(at.back());
  }
  return json.dump(1);
}

/// Refused: exit code 2, nothing on standard output, a message with place and words, and nothing written.
void expect_refused(const Folder& folder, const std::string& arguments, const std::string& place,
                    const std::string& says) {
  const Outcome outcome = folder.run(arguments);
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(place), std::string::npos) << outcome.err << "lacks " << place;
  EXPECT_EQ(outcome.err.find(".json#"), outcome.err.rfind(".json#")) << "two places: " << outcome.err;
  EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err << "lacks " << says;
  EXPECT_FALSE(std::filesystem::exists(folder / "out")) << arguments;
}

const Edit kScenes[] = {
    {"/version", "2", "#/version", "expected one of: 1"},
    {"/version", nullptr, "#", "'version' is missing"},
    {"/colour", "1", "#/colour", "unknown key"},
    {"/units/length", "3", "#/units/length", "wrong type"},
    {"/mesh", "7", "#/mesh", "wrong type"},
    {"/mesh", "\"\"", "#/mesh", "empty path"},
    {"/mesh", "\"no.off\"", "no.off", "No such file"},
    {"/bound_to", "\"nobody\"", "#/bound_to", "no curve-pair is called"},
    {"/bound_to", "[\"stem\", \"nobody\"]", "#/bound_to/1", "no curve-pair is called"},
    {"/bound_to", "[\"stem\", \"stem\"]", "#/bound_to/1", "named twice"},
    {"/bound_to", "[]", "#/bound_to", "a list of names"},
    {"/curve_pairs", "[]", "#/curve_pairs", "at least one"},
    {"/curve_pairs", nullptr, "#", "'curve_pairs' is missing"},
    {"/curve_pairs/1/name", "\"stem\"", "#/curve_pairs/1", "is taken"},
    {"/curve_pairs/0/points/1", "[0, 1]", "#/curve_pairs/0/points/1", "expected three finite numbers"},
    {"/curve_pairs/0/points/1/2", "\"a\"", "#/curve_pairs/0/points/1/2", "wrong type"},
    {"/curve_pairs/0/points/1", "[0, 0, 0]", "#/curve_pairs/0/points/1", "same point as the one before"},
    {"/curve_pairs/0/points", "[[0, 0, 0]]", "#/curve_pairs/0/points", "at least 2"},
    {"/curve_pairs/0/points", "[[0, 0, 0], [0, 1e308, 0], [0, -1e308, 0]]", "#/curve_pairs/0/points/2",
     "too far"},
    {"/curve_pairs/0/nodes", "1", "#/curve_pairs/0/nodes", "from 2 to 100000"},
    {"/curve_pairs/0/nodes", "2.5", "#/curve_pairs/0/nodes", "wrong type"},
    {"/curve_pairs/0/orientation", "[0, 1, 0]", "#/curve_pairs/0/orientation", "along the tangent"},
    {"/curve_pairs/0/orientation", "[0, 0, 0]", "#/curve_pairs/0/orientation",
     "along the tangent there, or zero"},
    {"/curve_pairs/1/orientation", "[[1, 1, 1], [1, 1, 2]]", "#/curve_pairs/1/orientation",
     "one for each of the 4"},
    {"/curve_pairs/1/orientation/2", "[1.4, 1, 0]", "#/curve_pairs/1", "no frame"},
    {"/curve_pairs/0/material/young", "-1", "#/curve_pairs/0/material/young", "out of range"},
    {"/curve_pairs/0/material/shear", "1e4", "#/curve_pairs/0/material", "one of them, not both"},
    {"/curve_pairs/0/material/poisson", "0.7", "#/curve_pairs/0/material/poisson", "at most 0.5"},
    {"/curve_pairs/0/material", nullptr, "#/curve_pairs/0", "'material' is missing"},
    {"/curve_pairs/0/section/type", "\"star\"", "#/curve_pairs/0/section/type", "\"circular\""},
    {"/curve_pairs/0/section/radius", "[0.1, 0.1]", "#/curve_pairs/0/section/radius",
     "one for each of the 3"},
    {"/curve_pairs/0/section/radius", "[0.1, 0, 0.1]", "#/curve_pairs/0/section/radius/1", "out of range"},
    {"/curve_pairs/0/section/radius", "1e-200", "#/curve_pairs/0", "expected"},
    {"/curve_pairs/0/section/a", "1", "#/curve_pairs/0/section/a", "not a size of a section"},
    {"/curve_pairs/0/springs", "{}", "#/curve_pairs/0/springs", "is missing"},
    {"/curve_pairs/1/section", R"({"type": "circular", "radius": 1})", "#/curve_pairs/1",
     "springs as well as"},
    {"/curve_pairs/1/springs/stretch", "0", "#/curve_pairs/1/springs/stretch", "out of range"},
    {"/curve_pairs/0/reach", "-1", "#/curve_pairs/0/reach", "out of range"},
    {"/curve_pairs/0/viscosity", "-1", "#/curve_pairs/0/viscosity", "at least 0"},
    {"/curve_pairs/0/anchors/0/node", "6", "#/curve_pairs/0/anchors/0/node", "from -1 to 5"},
    {"/curve_pairs/0/anchors/0/nodes", "[0, 1]", "#/curve_pairs/0/anchors/0", "one of them, not both"},
    {"/curve_pairs/1/anchors/0/nodes", "[2, 1]", "#/curve_pairs/1/anchors/0/nodes", "ends before it starts"},
    {"/curve_pairs/0/anchors/1", R"({"node": 0})", "#/curve_pairs/0/anchors/1", "anchored twice"},
    {"/curve_pairs/0/anchors/0/hold", "\"feet\"", "#/curve_pairs/0/anchors/0/hold", "\"position\""},
    {"/curve_pairs/0/anchors/0/slide", "{}", "#/curve_pairs/0/anchors/0/slide", "one of them, not both"},
    {"/curve_pairs/0/anchors/0/slide", R"({"along": [0, 0, 0]})", "#/curve_pairs/0/anchors/0/slide/along",
     "no direction"},
    {"/curve_pairs/0/anchors/0", R"({"node": 0, "hold": "frame", "slide": {"across": [0, 0, 1]}})",
     "#/curve_pairs/0/anchors/0/slide", "a hold of"},
    {"/curve_pairs/0/anchors/0/swivel", "[0, 0, 0]", "#/curve_pairs/0/anchors/0/swivel", "no direction"},
    {"/curve_pairs/0/anchors/0", R"({"node": 0, "hold": "position", "swivel": [0, 0, 1]})",
     "#/curve_pairs/0/anchors/0/swivel", "a hold of"},
    {"/curve_pairs/1/anchors/0/rotation/axis", "[0, 0, 0]", "#/curve_pairs/1/anchors/0/rotation/axis",
     "no direction"},
    {"/curve_pairs/1/joint", R"({"curve_pair": "tree", "node": 0})", "#/curve_pairs/1/joint/curve_pair",
     "is called"},
    {"/curve_pairs/1/joint", R"({"curve_pair": "stem", "node": 6})", "#/curve_pairs/1/joint/node",
     "from -1 to 5"},
    {"/curve_pairs/1/joint", R"({"curve_pair": "chain", "node": 1})", "#/curve_pairs/1/joint/curve_pair",
     "earlier"},
    {"/curve_pairs/1/joint", R"({"curve_pair": "stem", "node": 1})", "#/curve_pairs/1/joint", "joints[0]"},
    {"/forces/0/acceleration", "[0, 0]", "#/forces/0/acceleration", "three finite numbers"},
    {"/forces/0/stiffness", "1", "#/forces/0/stiffness", "not a key of the force 'gravity'"},
    {"/forces/0/type", "\"magic\"", "#/forces/0/type", "\"wind\""},
    {"/forces/0/acceleration", nullptr, "#/forces/0", "'acceleration' is missing"},
    {"/forces/1/gust", "-0.1", "#/forces/1/gust", "at least 0"},
    {"/forces/1/switched/table/0/0", "5", "#/forces/1/switched/table", "ascending times"},
    {"/forces/2/curve_pair", "\"leaf\"", "#/forces/2/curve_pair", "no curve-pair is called"},
    {"/forces/2/node", "60", "#/forces/2/node", "from -1 to 5"},
    {"/forces/2/signal", "{}", "#/forces/2/signal", "one of them, not both"},
    {"/simulation/duration", "0", "#/simulation/duration", "a positive number"},
    {"/simulation/output_every", "0.01", "#/simulation", "one of them, not both"},
    {"/simulation/frames", "100001", "#/simulation/frames", "from 2 to 10000"},
    {"/simulation/degree", "6", "#/simulation/degree", "from 1 to 5"},
    {"/simulation/method", "\"rk4\"", "#/simulation/method", "\"runge_kutta4\""},
    {"/simulation/method", "\"verlet\"", "#/simulation", "'fixed_step' is missing"},
    {"/simulation/fixed_step", "0.001", "#/simulation/fixed_step", "chooses its own"},
    {"/simulation/parametrisation", "\"chordal\"", "#/simulation/parametrisation", "\"centripetal\""},
    {"/picture/up", "[0, 0, 0]", "#/picture/up", "no direction"},
    {"/picture/size", "[96, 8]", "#/picture/size/1", "from 16 to 8192"},
    {"/twist", "true", "#/twist", "one of:"},
};

TEST(BadInput, ScenesAreRefusedWithThePlaceAndTheReason) {
  for (const Edit& edit : kScenes) {
    SCOPED_TRACE(std::string(edit.pointer) + " = " + (edit.value != nullptr ? edit.value : "absent"));
    const Folder folder;
    folder.write("tube.off", tube_off());
    folder.write("scene.json", edited(full_scene(), edit));
    const std::string place = edit.place[0] == '#' ? std::string("scene.json") + edit.place : edit.place;
    expect_refused(folder, "run scene.json --out out", place + ":", edit.says);
  }
}

TEST(BadInput, TextThatIsNotJsonIsRefusedWithLineAndColumn) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "scene.json:1:"},
      {"{\n  \"version\": 1,\n}", "scene.json:3:1:"},
      {"{\"version\": 1e999}", "scene.json:1:17:"},
      {"{\"version\": NaN}", "scene.json:1:13:"},
      {"{\"version\": 1} {}", "scene.json:1:16:"},
      {"{\"version\": 1, \"simulation\": {\"duration\": 1, \"duration\": 2}}",
       "scene.json#/simulation/duration:"},
      {"[1, 2]", "scene.json#:"},
      {"\xff\xfe", "scene.json:1:1:"},
  };
  for (const auto& [text, place] : cases) {
    SCOPED_TRACE(text);
    const Folder folder;
    folder.write("scene.json", text);
    expect_refused(folder, "run scene.json --out out", place, "expected");
  }
  const Folder folder;
  folder.write("scene.json", std::string(100000, '['));
  expect_refused(folder, "run scene.json --out out", "scene.json#", "nested too deeply");
}

const char* const kSpline = R"({"version": 1, "degree": 2, "knots": [0, 0, 0, 1, 1, 1],
  "control_points": [[0, 0, 0], [0, 0.5, 0], [0, 1, 0]],
  "orientation_control_points": [[1, 0, 0], [1, 0.5, 0], [1, 1, 0]]})";

const Edit kCurves[] = {
    {"/degree", "0", "#/degree", "from 1 to 5"},
    {"/degree", "3", "#/knots", "expected"},
    {"/knots/3", "0.5", "#/knots", "clamped"},
    {"/knots/1", "-1", "#/knots", "knots[1]"},
    {"/knots", nullptr, "#", "'knots' is missing"},
    {"/knots/2", "null", "#/knots/2", "wrong type"},
    {"/control_points", "[[0, 0, 0], [0, 1, 0]]", "#/control_points", "2 control points; expected 3"},
    {"/control_points/1", "[0, 1]", "#/control_points/1", "three finite numbers"},
    {"/orientation_control_points", nullptr, "#", "'orientation_control_points' is missing"},
    {"/points", "[[0, 0, 0], [0, 1, 0]]", "#/points", "not both"},
    {"/version", "\"1\"", "#/version", "expected one of: 1"},
    {"/weights", "[1, 1, 1]", "#/weights", "unknown key"},
};

TEST(BadInput, CurvesAreRefusedWithThePlaceAndTheReason) {
  for (const Edit& edit : kCurves) {
    SCOPED_TRACE(std::string(edit.pointer) + " = " + (edit.value != nullptr ? edit.value : "absent"));
    const Folder folder;
    folder.write("tube.off", tube_off());
    folder.write("good.json", kSpline);
    folder.write("points.csv", "0,0,0\n");
    folder.write("curve.json", edited(kSpline, edit));
    const std::string place = std::string("curve.json") + edit.place + ":";
    expect_refused(folder, "project curve.json points.csv", place, edit.says);
    expect_refused(folder, "deform tube.off --axis good.json --pose curve.json --out out", place, edit.says);
  }
}

TEST(BadInput, PosesOnOtherKnotsAreRefused) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("rest.json", kSpline);
  folder.write("pose.json", edited(kSpline, {"/knots", "[0, 0, 0, 2, 2, 2]", "", ""}));
  expect_refused(folder, "deform tube.off --axis rest.json --pose pose.json --out out",
                 "pose.json#:", "the same, or --equal-length");
}

TEST(BadInput, PointFilesAreRefusedWithTheLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "points.csv:"},
      {"x,y,z\n", "points.csv:"},
      {"1,2\n", "points.csv:1:"},
      {"x,y,z\n1,2,3\n1,2,3,4\n", "points.csv:3:"},
      {"1,2,3\nx,y,z\n", "points.csv:2:"},
      {"# only\n\n1,2,nan\n", "points.csv:3:"},
      {"nan,nan,nan\n", "points.csv:1:"},
      {"1,2,1e999\n", "points.csv:1:"},
      {"1;2;3\n", "points.csv:1:"},
      {"1,,3\n", "points.csv:1:"},
      {"1,2,3x\n", "points.csv:1:"},
  };
  for (const auto& [text, place] : cases) {
    SCOPED_TRACE(text);
    const Folder folder;
    folder.write("curve.json", kSpline);
    folder.write("points.csv", text);
    expect_refused(folder, "project curve.json points.csv --json", place, "expected");
  }
}

TEST(BadInput, PointFilesMayHaveAMarkPlusSignsBlanksAnIdOrAHeader) {
  for (const char* text : {"\xEF\xBB\xBF"
                           "0,1,2\n",
                           "+0,+1,+2\n", "0 1\t2\n", "7,0,1,2\n", "id,z,y,x\n7,2,1,0\n"}) {
    SCOPED_TRACE(text);
    const Folder folder;
    folder.write("curve.json", kSpline);
    folder.write("points.csv", "0,1,2\n");
    const Outcome plain = folder.run("project curve.json points.csv --json");
    folder.write("points.csv", text);
    const Outcome same = folder.run("project curve.json points.csv --json");
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_EQ(same.out, plain.out);
  }
}

TEST(BadInput, MeshesAreRefusedByEverySubcommandThatReadsThem) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "tube.off"},
      {"OFF\n", "tube.off:"},
      {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "tube.off:6"},
      {"OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "tube.off:4"},
      {"OFF\n3 1 0\n0 0 0\n1 0 0\n", "tube.off:"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n", "tube.off:"},
  };
  for (const auto& [text, place] : cases) {
    SCOPED_TRACE(text);
    const Folder folder;
    folder.write("tube.off", text);
    folder.write("scene.json", full_scene());
    folder.write("curve.json", kSpline);
    expect_refused(folder, "check tube.off --json", place, "expected");
    expect_refused(folder, "run scene.json --out out", place, "expected");
    expect_refused(folder, "render tube.off --out out", place, "expected");
    expect_refused(folder, "deform tube.off --axis curve.json --pose curve.json --out out", place,
                   "expected");
  }
}

TEST(BadInput, CommandLinesAreRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "subcommand"},
      {"dance", "subcommand"},
      {"run scene.json", "--out"},
      {"run missing.json --out out", "missing.json"},
      {"run scene.json --out out --threads -1", "--threads"},
      {"run scene.json --out out --threads many", "--threads"},
      {"run scene.json --out out --quickly", "--quickly"},
      {"run scene.json --out out --mesh nothere.off", "nothere.off"},
      {"render tube.off --out out --size 10x10", "--size"},
      {"render tube.off --out out --size 100", "--size"},
      {"render tube.off --out out --view 10,95", "--view"},
      {"render tube.off --out out --up w", "--up"},
      {"render tube.off --out out --samples 0", "--samples"},
      {"deform tube.off --axis curve.json --pose curve.json --out out", "ply"},
  };
  for (const auto& [arguments, says] : cases) {
    SCOPED_TRACE(arguments);
    const Folder folder;
    folder.write("tube.off", tube_off());
    folder.write("scene.json", full_scene());
    folder.write("curve.json", kSpline);
    expect_refused(folder, arguments, "", says);
  }
}

TEST(BadInput, AFileInTheWayOfTheFolderIsLeftAlone) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("scene.json", full_scene());
  folder.write("taken", "mine");
  const Outcome outcome = folder.run("run scene.json --out taken");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("taken"), std::string::npos);
  EXPECT_EQ(bytes_of(folder / "taken"), "mine");
}

}  // namespace
}  // namespace tendril::test
