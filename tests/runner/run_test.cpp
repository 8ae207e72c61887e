#include "runner/program.h"

#include <tendril/bind/import.h>

#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// All files of a folder by name; summary.json without its timings.
std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    out[name] = bytes_of(entry.path());
    if (name != "summary.json") continue;
    Json summary = Json::parse(out[name]);
    EXPECT_EQ(summary.erase("wall_s"), 1U);
    out[name] = summary.dump();
  }
  return out;
}

TEST(Run, GivesTheSameBitsAgainAndForAnyNumberOfThreads) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("scene.json", full_scene());
  for (const char* run : {"--out a --threads 1 --film a/film.apng", "--out b --threads 1 --film b/film.apng",
                          "--out c --threads 5 --film c/film.apng"}) {
    const Outcome outcome = folder.run(std::string("run scene.json ") + run);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const auto first = contents(folder / "a");
  EXPECT_EQ(first.size(), 6U + 5U);  // frames, trajectory, summary, two pictures, the film
  EXPECT_EQ(first, contents(folder / "b"));
  EXPECT_EQ(first, contents(folder / "c"));
  EXPECT_NE(first.at("frame_0000.ply"), first.at("frame_0005.ply"));
}

TEST(Run, PrintsTheSummaryAndNothingElse) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("scene.json", full_scene());
  const Outcome outcome = folder.run("run scene.json --out out --json --no-frames --no-pictures");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Json summary = Json::parse(outcome.out);
  EXPECT_EQ(summary, Json::parse(bytes_of(folder / "out/summary.json")));
  EXPECT_EQ(summary.at("status"), "finished");
  EXPECT_EQ(summary.at("time"), 0.1);
  EXPECT_GT(summary.at("rhs_evaluations"), summary.at("steps_accepted"));
  EXPECT_LT(std::abs(summary.at("energy").at("imbalance").get<double>()), 1e-3);
  EXPECT_EQ(summary.at("files"), Json::parse(R"(["trajectory.csv"])"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/frame_0000.ply"));
}

TEST(Run, FirstFrameIsTheMeshAndTheTrajectoryHasEveryMass) {
  const Folder folder;
  const std::string mesh = folder.write("tube.off", tube_off());
  folder.write("scene.json", full_scene());
  ASSERT_EQ(folder.run("run scene.json --out out --double --no-pictures").code, 0);
  const auto rest = bind::read_mesh(mesh), first = bind::read_mesh(folder / "out/frame_0000.ply");
  ASSERT_EQ(first.points.size(), rest.points.size());
  for (std::size_t i = 0; i < rest.points.size(); ++i) {
    EXPECT_LT((first.points[i] - rest.points[i]).norm(), 1e-14);
  }
  EXPECT_EQ(first.corners, rest.corners);
  const std::string trajectory = bytes_of(folder / "out/trajectory.csv");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 1 + 6 * (6 + 4));
  EXPECT_NE(trajectory.find("\n0,0,0,0,0,0,"), std::string::npos);
}

TEST(Run, PointsOutOfReachStayWhereTheyAre) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["reach"] = Json::parse("[1, 1, 0.01]");
  folder.write("scene.json", scene.dump());
  ASSERT_EQ(folder.run("run scene.json --out out --double --no-pictures").code, 0);
  const auto first = bind::read_mesh(folder / "out/frame_0000.ply");
  const auto last = bind::read_mesh(folder / "out/frame_0005.ply");
  const std::size_t top = first.points.size() - 1, middle = first.points.size() / 2;
  EXPECT_EQ(last.points[top], first.points[top]);
  EXPECT_GT((last.points[middle] - first.points[middle]).norm(), 1e-6);
}

TEST(Run, SaysWhatTheMotionSpoils) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json scene = Json::parse(full_scene());
  folder.write("scene.json", scene.dump());
  const Outcome whole = folder.run("run scene.json --out whole --no-pictures");
  EXPECT_EQ(whole.err, "");
  EXPECT_EQ(Json::parse(bytes_of(folder / "whole/summary.json")).at("distortion").at("spoilt_area"), 0.0);

  // What is out of reach stays, and all else is carried away from it.
  scene["curve_pairs"][0]["reach"] = Json::parse("[1, 1, 0.01]");
  scene["curve_pairs"][0]["anchors"][0]["translation"] = {{"velocity", {30, 0, 0}}};
  folder.write("scene.json", scene.dump());
  const Outcome torn = folder.run("run scene.json --out torn --no-pictures");
  ASSERT_EQ(torn.code, 0) << torn.err;
  EXPECT_NE(torn.err.find("note: at time 0.1 the motion spoils "), std::string::npos) << torn.err;
  const Json found = Json::parse(bytes_of(folder / "torn/summary.json")).at("distortion");
  EXPECT_GT(found.at("stretched"), 0);
  EXPECT_GT(found.at("most_stretch"), 10.0);
  EXPECT_EQ(found.at("time"), 0.1);
  EXPECT_GT(found.at("zone").at("radius"), 0.0);
}

TEST(Run, ExitsWithOneAndTheReasonWhenTheWorkLimitIsTooSmall) {
  const Folder folder;
  Json scene = Json::parse(full_scene());
  scene["mesh"] = nullptr;
  scene["simulation"]["work_limit"] = 50;
  folder.write("scene.json", scene.dump());
  const Outcome outcome = folder.run("run scene.json --out out --json --no-pictures");
  EXPECT_EQ(outcome.code, 1);
  const Json summary = Json::parse(outcome.out);
  EXPECT_TRUE(summary.at("status") == "too_stiff" || summary.at("status") == "work_limit") << outcome.out;
  EXPECT_NE(summary.at("reason"), "");
  EXPECT_NE(outcome.err.find(summary.at("reason").get<std::string>()), std::string::npos);
  EXPECT_NE(outcome.err.find("what may help: a larger \"work_limit\""), std::string::npos) << outcome.err;
}

TEST(Run, DrawsWhatItHasWhereItStoppedBeforeTheOutputsOfTheSheet) {
  const Folder folder;
  Json scene = Json::parse(full_scene());
  scene["mesh"] = nullptr;
  scene["simulation"]["work_limit"] = 50;
  scene["picture"]["panels"] = 1;
  folder.write("scene.json", scene.dump());
  EXPECT_EQ(folder.run("run scene.json --out out").code, 1);
  EXPECT_FALSE(bytes_of(folder / "out/contact_sheet.png").empty());
  EXPECT_FALSE(bytes_of(folder / "out/final.png").empty());
}

TEST(Run, TakesTheStepsOfTheMethodTheSceneNames) {
  const Folder folder;
  Json scene = Json::parse(full_scene());
  scene["mesh"] = nullptr;
  scene["simulation"] = {{"duration", 0.1}, {"frames", 3}, {"method", "verlet"}, {"fixed_step", 1.0}};
  folder.write("scene.json", scene.dump());
  const auto run = [&] { return folder.run("run scene.json --out out --json --no-pictures"); };
  const Outcome outcome = run();
  const Json summary = Json::parse(outcome.out);
  EXPECT_NE(outcome.err.find("what may help: a \"fixed_step\" below 1\n"), std::string::npos) << outcome.err;
  EXPECT_EQ(summary.at("integrator"), "velocity Verlet");
  EXPECT_EQ(summary.at("fixed_step"), 1.0);
  EXPECT_EQ(summary.at("status"), "too_stiff");
  const double limit = summary.at("guard_step").get<double>();
  scene["simulation"]["fixed_step"] = 0.2 * limit;
  folder.write("scene.json", scene.dump());
  const Json gentle = Json::parse(run().out);
  EXPECT_EQ(gentle.at("status"), "finished") << gentle.at("reason");
  EXPECT_EQ(gentle.at("steps_accepted"), 2 * std::ceil(0.05 / (0.2 * limit)));
}

/// Starts the program without waiting.
pid_t start(const Folder& folder, std::vector<std::string> arguments) {
  const pid_t child = fork();
  if (child != 0) return child;
  std::vector<char*> argv;
  static std::string program = TENDRIL_PROGRAM;
  argv.push_back(program.data());
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  if (chdir(folder.path().c_str()) != 0 || freopen("/dev/null", "w", stderr) == nullptr ||
      freopen("/dev/null", "w", stdout) == nullptr) {
    _exit(126);
  }
  execv(argv[0], argv.data());
  _exit(127);
}

bool appears(const std::string& path) {
  for (int i = 0; i < 600; ++i) {
    if (std::filesystem::exists(path)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(Run, CtrlCLeavesWholeFilesAndASummary) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json scene = Json::parse(full_scene());
  // The damped stem alone under gravity: a run that would go on for long, whatever the machine's speed.
  scene["curve_pairs"].erase(1);
  scene["forces"] = Json::array({scene["forces"][0]});
  scene["simulation"] = {
      {"duration", 5000}, {"output_every", 1.0}, {"tolerance", 1e-4}, {"work_limit", 4000000000}};
  folder.write("scene.json", scene.dump());
  const pid_t child = start(folder, {"run", "scene.json", "--out", "out"});
  ASSERT_TRUE(appears(folder / "out/frame_0002.ply"));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);

  const Json summary = Json::parse(bytes_of(folder / "out/summary.json"));
  EXPECT_EQ(summary.at("status"), "cancelled");
  const long outputs = summary.at("outputs").get<long>();
  const std::string trajectory = bytes_of(folder / "out/trajectory.csv");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 1 + outputs * 6);
  long frames = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".ply") {
      EXPECT_TRUE(name == "summary.json" || name == "trajectory.csv") << name;
      continue;
    }
    EXPECT_EQ(bind::read_mesh(entry.path().string()).points.size(), 36U) << name;
    ++frames;
  }
  EXPECT_EQ(frames, outputs);
}

TEST(Deform, KeepsTheMeshWhenTheAxisStaysAndLengthWhenAsked) {
  const Folder folder;
  const std::string mesh = folder.write("tube.off", tube_off());
  folder.write("rest.json",
               R"({"version": 1, "degree": 1, "points": [[0, 0, 0], [0, 1, 0]], "orientation": [1, 0, 0]})");
  folder.write("long.json",
               R"({"version": 1, "degree": 1, "points": [[0, 0, 0], [0, 2, 0]], "orientation": [1, 0, 0]})");
  ASSERT_EQ(folder.run("deform tube.off --axis rest.json --pose rest.json --out same.ply").code, 0);
  ASSERT_EQ(folder.run("deform tube.off --axis rest.json --pose long.json --out twice.ply").code, 0);
  ASSERT_EQ(
      folder.run("deform tube.off --axis rest.json --pose long.json --out kept.ply --equal-length").code, 0);
  const auto rest = bind::read_mesh(mesh), same = bind::read_mesh(folder / "same.ply"),
             twice = bind::read_mesh(folder / "twice.ply"), kept = bind::read_mesh(folder / "kept.ply");
  for (std::size_t i = 0; i < rest.points.size(); ++i) {
    const Vec3& p = rest.points[i];
    EXPECT_LT((same.points[i] - p).norm(), 1e-14);
    EXPECT_LT((twice.points[i] - Vec3(p.x(), 2.0 * p.y(), p.z())).norm(), 1e-13);
    EXPECT_LT((kept.points[i] - p).norm(), 1e-13);
  }
}

TEST(Project, GivesTheWholeProjection) {
  const Folder folder;
  folder.write("axis.json",
               R"({"version": 1, "degree": 1, "points": [[0, 0, 0], [0, 2, 0]], "orientation": [1, 0, 0]})");
  folder.write("points.csv", "x,y,z\n0.5,0.5,0  # inside\n0,3,0\n");
  const Outcome outcome = folder.run("project axis.json points.csv --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json points = Json::parse(outcome.out).at("points");
  ASSERT_EQ(points.size(), 2U);
  EXPECT_NEAR(points[0].at("t").get<double>(), 0.25, 1e-14);
  EXPECT_NEAR(points[0].at("distance").get<double>(), 0.5, 1e-14);
  EXPECT_NEAR(points[0].at("v").get<double>(), 0.5, 1e-14);  // y points to the orientation curve
  EXPECT_EQ(points[0].at("kind"), "interior");
  EXPECT_EQ(points[0].at("frame"), "ok");
  EXPECT_EQ(points[1].at("kind"), "end");
  EXPECT_NEAR(points[1].at("w").get<double>(), 1.0, 1e-14);
  EXPECT_EQ(points[1].at("point"), Json::parse("[0.0, 2.0, 0.0]"));
  EXPECT_NEAR(points[1].at("lambda").get<double>(), 1.0, 1e-14);
  EXPECT_LT(points[1].at("gap").get<double>(), 1e-12);
}

TEST(Project, FindsTheNearestOfAListOfCurves) {
  const Folder folder;
  folder.write("axes.json", R"({"version": 1, "curves": [
    {"name": "up", "degree": 1, "points": [[0, 0, 0], [0, 2, 0]], "orientation": [1, 0, 0]},
    {"degree": 1, "points": [[5, 0, 0], [5, 0, 2]], "orientation": [1, 0, 0]}]})");
  folder.write("points.csv", "1,1,0\n5,1,1\n");
  const Outcome outcome = folder.run("project axes.json points.csv --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["points"][0]["curve"], "up");
  EXPECT_NEAR(json["points"][0]["distance"].get<double>(), 1.0, 1e-14);
  EXPECT_EQ(json["points"][1]["curve"], "1");
  EXPECT_NEAR(json["points"][1]["t"].get<double>(), 0.5, 1e-14);
  const std::string rows = folder.run("project axes.json points.csv").out;
  EXPECT_EQ(rows.substr(0, rows.find(',', 6)), "curve,t");
  EXPECT_NE(rows.find("\nup,0.5,0,1,0,1,"), std::string::npos) << rows;
}

TEST(Commands, SayWhatThereIs) {
  const Folder folder;
  const Outcome unknown = folder.run("frobnicate x");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("'frobnicate' is no subcommand; expected one of run axis"), std::string::npos)
      << unknown.err;
  folder.write("tube.off", tube_off());
  const Outcome other = folder.run("render tube.off --out tube.JPG");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("PNG"), std::string::npos) << other.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "tube.JPG"));
}

TEST(Check, CallsPointsAloneNoSurface) {
  const Folder folder;
  folder.write("points.off", "OFF\n1 0 0\n1 2 3\n");
  EXPECT_NE(folder.run("check points.off").out.find("no faces"), std::string::npos);
  EXPECT_EQ(Json::parse(folder.run("check points.off --json").out)["closed"], false);
}

TEST(Check, CountsAndLoads) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  const Outcome outcome = folder.run("check tube.off --json");
  ASSERT_EQ(outcome.code, 0);
  const Json report = Json::parse(outcome.out);
  EXPECT_EQ(report.at("points"), 36);
  EXPECT_EQ(report.at("faces"), 32);
  EXPECT_EQ(report.at("boundary_loops"), 2);
  EXPECT_EQ(folder.run("check tube.off").code, 0);
  EXPECT_EQ(folder.run("--help").code, 0);
  for (const char* sub : {"run", "deform", "project", "check", "render"}) {
    const Outcome help = folder.run(std::string(sub) + " --help");
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("--json"), std::string::npos);
  }
}

/// The tube of full_scene() between two curve-pairs, of which the second turns: what is nearer to that goes
/// with it.
TEST(Run, AMeshOfTwoCurvePairsFollowsBoth) {
  const Folder folder;
  folder.write("tube.off", tube_off(17));
  Json scene = Json::parse(full_scene());
  scene["forces"] = Json::array();
  scene["curve_pairs"][0]["points"] = Json::parse("[[0, 0, 0], [0, 0.2, 0], [0, 0.4, 0]]");
  scene["curve_pairs"][0]["anchors"] = Json::parse(R"([{"nodes": [0, 5], "hold": "both"}])");
  scene["curve_pairs"][0].erase("reach");
  Json& second = scene["curve_pairs"][1];
  second["points"] = Json::parse("[[0, 0.6, 0], [0, 0.75, 0], [0, 0.9, 0], [0, 1, 0]]");
  second["orientation"] = {1, 0, 0};
  second["anchors"] = Json::parse(
      R"([{"nodes": [0, 3], "hold": "position", "translation": {"amplitude": [0.2, 0, 0], "frequency": 2.5}}])");
  scene["bound_to"] = {"stem", "chain"};
  folder.write("scene.json", scene.dump());
  const Outcome outcome = folder.run("run scene.json --out out --no-pictures --double --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json summary = Json::parse(outcome.out);
  EXPECT_GT(summary.at("binding").at("ambiguous").get<int>(), 0);
  EXPECT_LT(summary.at("binding").at("rest_error").get<double>(), 1e-14);
  const bind::PolygonMesh rest = bind::read_mesh(folder / "tube.off");
  const bind::PolygonMesh last = bind::read_mesh(folder / "out/frame_0005.ply");
  for (std::size_t i = 0; i < rest.points.size(); ++i) {
    const Vec3 move = last.points[i] - rest.points[i];
    if (rest.points[i].y() < 0.3) EXPECT_LT(move.norm(), 1e-9);
    if (rest.points[i].y() > 0.8) EXPECT_NEAR(move.x(), 0.2, 1e-6);
    EXPECT_LE(std::abs(move.x()), 0.25);
  }
}

/// A scene that does not say what its mesh follows has it follow the first curve-pair, which is said where
/// there are others beside it.
TEST(Run, SaysWhatAMeshDoesNotFollow) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json json = Json::parse(full_scene());
  folder.write("named.json", json.dump());
  json.erase("bound_to");
  folder.write("plain.json", json.dump());
  const Outcome named = folder.run("run named.json --out a --no-frames --no-pictures");
  EXPECT_EQ(named.code, 0) << named.err;
  EXPECT_EQ(named.err.find("bound_to"), std::string::npos) << named.err;
  const Outcome plain = folder.run("run plain.json --out b --no-frames --no-pictures");
  EXPECT_EQ(plain.code, 0) << plain.err;
  EXPECT_NE(plain.err.find("follows 'stem' and what is joined to it, not 'chain'"), std::string::npos)
      << plain.err;
}

/// Frames of a longer run in the folder are no part of this one, which is said.
TEST(Run, SaysWhatAnotherRunHasLeft) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  Json json = Json::parse(full_scene());
  for (const int frames : {5, 3}) {
    json["simulation"]["frames"] = frames;
    json["simulation"].erase("outputs");
    folder.write("scene.json", json.dump());
    const Outcome outcome = folder.run("run scene.json --out a --no-pictures");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("from frame_0003.ply on") != std::string::npos, frames == 3) << outcome.err;
  }
}

}  // namespace
}  // namespace tendril::test
