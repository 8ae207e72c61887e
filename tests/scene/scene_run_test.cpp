#include <gtest/gtest.h>
#include <tendril/bind/import.h>
#include <tendril/scene/scene_run.h>
#include <tendril/scene/summary.h>
#include <tendril/scene/trajectory.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scene/full_scene.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

scene::SceneFile file_of(const Json& scene) {
  return scene::parse_scene(scene.dump(), "scene.json");
}

scene::SceneRun full_run() {
  return {file_of(Json::parse(full_scene())), bind::parse_off(tube_off(), "tube.off")};
}

TEST(SceneRun, HandsOutSnapshotsAtTheOutputsAndGivesTheSystemsOwnNumbers) {
  scene::SceneRun run = full_run();
  std::vector<scene::Snapshot> seen;
  const Report report = run.run([&](const scene::Snapshot& now) { seen.push_back(now); });
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_EQ(seen.size(), run.file().outputs.size());
  for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k].time, run.file().outputs[k]);
  const System system(run.file().scene);
  Simulation simulation(system, system.rest_state(), run.file().options);
  simulation.run(run.file().duration, run.file().outputs);
  for (std::size_t r = 0; r < 2; ++r) {
    const NodeRange rod = system.rods()[r];
    ASSERT_EQ(seen.back().masses[r].size(), rod.count);
    for (std::size_t i = 0; i < rod.count; ++i) {
      const Vec3 p = simulation.state().y.segment<3>(3 * static_cast<Eigen::Index>(rod.first + i));
      EXPECT_EQ(seen.back().masses[r][i], p);
    }
    EXPECT_TRUE(std::ranges::equal(seen.back().pairs[r].primary().control_points(),
                                   simulation.pairs()[r].primary().control_points()));
  }
}

TEST(SceneRun, MovesTheMeshWithItsBindingAndStartsFromTheMeshItself) {
  scene::SceneRun run = full_run();
  const std::vector<Vec3> rest = run.mesh()->mesh().points;
  std::vector<scene::Snapshot> seen;
  run.run([&](const scene::Snapshot& now) { seen.push_back(now); });
  double moved = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_LT((seen.front().points[i] - rest[i]).norm(), 1e-14);
    moved = std::max(moved, (seen.back().points[i] - rest[i]).norm());
  }
  EXPECT_GT(moved, 1e-4);
  std::vector<Vec3> expected(rest.size());
  run.mesh()->binding().update(std::span(seen.back().pairs).first(1), expected);
  EXPECT_EQ(seen.back().points, expected);
}

TEST(SceneRun, IsCancelledByItsProgressAndSaysHowFarItGot) {
  scene::SceneRun run = full_run();
  double last = 0.0;
  const Report report = run.run({}, [&](double part) {
    EXPECT_GT(part, last);
    last = part;
    return part < 0.3;
  });
  EXPECT_EQ(report.stop, Stop::cancelled);
  EXPECT_NEAR(report.time, last * run.file().duration, 1e-15);
  EXPECT_LT(report.time, run.file().duration);
}

TEST(SceneRun, BeginsWhereItIsTold) {
  scene::SceneRun first = full_run();
  first.run();
  scene::RunOptions options;
  options.start = first.simulation().state();
  scene::SceneRun second(first.file(), bind::PolygonMesh{}, options);
  EXPECT_EQ(second.mesh(), nullptr);
  EXPECT_EQ(second.snapshot().time, first.file().duration);
  EXPECT_EQ(second.snapshot().masses, first.snapshot().masses);
}

TEST(SceneRun, WritesTrajectoryAndSummaryThatReadBack) {
  scene::SceneRun run = full_run();
  scene::Trajectory trajectory;
  scene::Snapshot last;
  const Report report = run.run([&](const scene::Snapshot& now) { trajectory.add(last = now); });
  std::istringstream lines(trajectory.csv());
  std::string line, end;
  while (std::getline(lines, line)) end = line;
  std::istringstream fields(end);
  std::vector<double> numbers;
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  const Vec3& p = last.masses[1].back();
  const Vec3& q = last.orientation[1].back();
  EXPECT_EQ(numbers, (std::vector<double>{last.time, 1, 3, p.x(), p.y(), p.z(), q.x(), q.y(), q.z()}));

  const Json summary =
      Json::parse(scene::summary_json(run, report, {{"a.ply"}, {{"one", 1.0}, {"two", 2.0}}}));
  EXPECT_EQ(summary.at("status"), "finished");
  EXPECT_EQ(summary.at("outputs"), 6);
  EXPECT_EQ(summary.at("files"), Json::parse(R"(["a.ply"])"));
  EXPECT_EQ(summary.at("wall_s"), Json::parse(R"({"one": 1.0, "two": 2.0, "total": 3.0})"));
  EXPECT_EQ(summary.at("energy").at("imbalance").get<double>(), report.imbalance);
}

/// An output at 0.013 100 / 100, which rounds to above 0.013.
TEST(SceneRun, ADurationThatItsFramesDoNotDivideIsRun) {
  Json json = Json::parse(full_scene());
  json["simulation"] = {{"duration", 0.013}};
  scene::SceneRun run(file_of(json), bind::PolygonMesh{});
  double last = 0.0;
  const Report report = run.run([&](const scene::Snapshot& now) { last = now.time; });
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(run.outputs(), 101U);
  EXPECT_EQ(last, 0.013);
}

/// What only the library can refuse is said of the scene's file, too.
TEST(SceneRun, RefusalsNameTheFileAndThePart) {
  Json json = Json::parse(full_scene());
  json["mesh"] = nullptr;
  scene::SceneFile file = file_of(json);
  file.outputs = {0.0, 2.0 * file.duration};
  try {
    scene::SceneRun(file).run();
    ADD_FAILURE() << "an output beyond the end was taken";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(error.at().file, "scene.json");
    EXPECT_EQ(error.at().pointer, "/simulation");
    EXPECT_EQ(error.at().line, 1U);
  }
  file = file_of(json);
  file.scene.anchors.back().node = 99;
  try {
    const scene::SceneRun run(file);
    ADD_FAILURE() << "an anchor at no node was taken";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(error.at().pointer, "/curve_pairs/1/anchors/0");
    EXPECT_EQ(error.place(), "scene.json#/curve_pairs/1/anchors/0");
  }
}

}  // namespace
}  // namespace tendril::test
