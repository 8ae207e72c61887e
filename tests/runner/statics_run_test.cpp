#include "runner/program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// A rod of unit length clamped at both ends, one of which comes nearer and turns by two turns.
Json twisted_scene() {
  return Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "rod", "points": [[0, 0, 0], [1, 0, 0]], "nodes": 21, "orientation": [0, 1, 0],
       "springs": {"stretch": 2e4, "bend_l": 0, "bend_m": 0, "bend_t": 40, "twist": 20, "mass": 0.05, "inertia": 1e-4},
       "anchors": [{"node": 0},
                   {"node": -1, "translation": {"velocity": [-0.05, 0, 0]},
                    "rotation": {"axis": [1, 0, 0], "rate": 12.566370614359172}}]}],
    "simulation": {"duration": 1}
  })");
}

TEST(Statics, FollowsAnEndThatTurnsAndSaysHowItStands) {
  const Folder folder;
  folder.write("scene.json", twisted_scene().dump());
  const Outcome outcome = folder.run("statics scene.json --out out --json --no-pictures");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json summary = Json::parse(outcome.out);
  EXPECT_EQ(summary.at("status"), "converged");
  EXPECT_EQ(summary.at("time"), 1.0);
  EXPECT_EQ(summary.at("stability").at("unstable_directions"), 0);
  EXPECT_GT(summary.at("unstable_branches_left").get<int>(), 0);
  EXPECT_LT(summary.at("residual").get<double>(), 1e-6);
  const std::string masses = bytes_of(folder / "out/trajectory.csv");
  EXPECT_EQ(std::count(masses.begin(), masses.end(), '\n'), 1 + 21);
  EXPECT_EQ(Json::parse(bytes_of(folder / "out/summary.json")).at("files"), Json::array({"trajectory.csv"}));
}

TEST(Statics, SaysWhyItFailsAndRefusesHalfAMotion) {
  const Folder folder;
  Json scene = twisted_scene();
  folder.write("scene.json", scene.dump());
  const Outcome limited = folder.run("statics scene.json --work-limit 3");
  EXPECT_EQ(limited.code, 1);
  EXPECT_NE(limited.err.find("work_limit"), std::string::npos) << limited.err;
  scene["curve_pairs"][0]["anchors"][1]["rotation"]["amplitude"] = 1.0;
  folder.write("scene.json", scene.dump());
  const Outcome refused = folder.run("statics scene.json");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("/curve_pairs/0/anchors/1/rotation"), std::string::npos) << refused.err;
}

/// A bar held at one point hangs down, a free one is held by nothing, and the scene says where loads begin.
TEST(Statics, FollowsWhatNothingResistsOrNamesIt) {
  const Folder folder;
  Json scene = Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "bar", "points": [[0, 0, 0], [1, 0, 0]], "nodes": 9, "orientation": [0, 0, 1],
       "material": {"young": 2e11, "poisson": 0.3, "density": 7850}, "section": {"type": "circular", "radius": 0.01},
       "anchors": [{"node": 0, "hold": "position"}]}],
    "forces": [{"type": "gravity", "acceleration": [0, -9.81, 0]}],
    "statics": {"first_load": 0.5},
    "simulation": {"duration": 1}
  })");
  folder.write("scene.json", scene.dump());
  const Outcome hung = folder.run("statics scene.json --out out --json --no-pictures");
  ASSERT_EQ(hung.code, 0) << hung.err;
  const Json summary = Json::parse(hung.out);
  EXPECT_LE(summary.at("residual").get<double>(), 1e-9);
  const double depth = -summary.at("energy").at("potential").get<double>() /
                       summary.at("supports")[0].at("force")[1].get<double>();
  EXPECT_NEAR(depth, 0.5, 1e-6);  // of the centre of mass
  const Outcome never = folder.run("statics scene.json --first-load 2 --load 2 --work-limit 1");
  EXPECT_NE(never.err.find("at load 2"), std::string::npos) << never.err;
  scene["curve_pairs"][0].erase("anchors");
  folder.write("scene.json", scene.dump());
  const Outcome falling = folder.run("statics scene.json");
  EXPECT_EQ(falling.code, 1);
  EXPECT_NE(falling.err.find("unheld: at load 0.5"), std::string::npos) << falling.err;
  EXPECT_NE(falling.err.find("nothing holds rod 0"), std::string::npos) << falling.err;
}

/// The numbers of a table's lines, without its header.
std::vector<std::vector<double>> rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(std::stod(field));
  }
  return rows;
}

/// Without friction a rod is followed down to a floor; with it that takes a start on the floor, which is
/// said.
TEST(Statics, SaysWhatHelpsWhereFrictionKeepsARodInTheAir) {
  const Folder folder;
  Json scene = Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "rod", "points": [[-0.6, 0, 0.05], [0, 0, 0.05], [0.6, 0, 0.05]], "nodes": 33, "orientation": [0, 1, 0],
       "material": {"young": 1e6, "poisson": 0.35, "density": 1000}, "section": {"type": "circular", "radius": 0.01}}],
    "bodies": [{"name": "floor", "shape": {"type": "half_space"}}],
    "contact": {"friction": 0.3},
    "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
    "simulation": {"duration": 1}
  })");
  folder.write("scene.json", scene.dump());
  const Outcome held = folder.run("statics scene.json");
  EXPECT_EQ(held.code, 1);
  EXPECT_NE(held.err.find("begin where it touches"), std::string::npos) << held.err;
  scene["contact"]["friction"] = 0;
  folder.write("scene.json", scene.dump());
  const Outcome fallen = folder.run("statics scene.json --out out --json --no-pictures");
  ASSERT_EQ(fallen.code, 0) << fallen.err;
  EXPECT_EQ(Json::parse(fallen.out)["stability"]["kind"], "neutral");
  const std::string contacts = bytes_of(folder / "out/contacts.csv");
  EXPECT_GT(std::count(contacts.begin(), contacts.end(), '\n'), 33);
}

/// A soft leaf lies on a ball: what that bears and what its clamp does are its weight.
TEST(Statics, FindsHowAMeshLiesOnASolid) {
  const Folder folder;
  const std::string scenes = std::string(TENDRIL_SOURCE_DIR) + "/examples/scenes/";
  Json scene = Json::parse(bytes_of(scenes + "ball_on_leaf_blade.json"), nullptr, true, true);
  folder.write("leaf.off", bytes_of(scenes + "leaf.off"));
  scene["curve_pairs"][0]["material"]["young"] = 5e6;
  scene["contact"]["damping"] = 0;
  scene["bodies"] = Json::parse(
      R"([{"name": "ball", "shape": {"type": "ball", "radius": 0.04}, "position": [0.55, 0.03, -0.06]}])");
  const auto support = [&] {
    folder.write("scene.json", scene.dump());
    const Outcome outcome = folder.run("statics scene.json --out out --json --no-pictures");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const Json force = Json::parse(outcome.out)["supports"][0]["force"];
    return std::array<double, 3>{force[0], force[1], force[2]};
  };
  std::array<double, 3> sum = support();
  std::istringstream contacts(bytes_of(folder / "out/mesh_contacts.csv"));
  std::string line;
  int touches = 0;
  for (std::getline(contacts, line); std::getline(contacts, line); ++touches) {
    std::vector<double> row;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) row.push_back(std::stod(word));
    ASSERT_EQ(row.size(), 17U);
    EXPECT_GT(row[3], 0.0);  // gap
    for (std::size_t i = 0; i < 3; ++i) sum[i] += row[10 + i];
  }
  EXPECT_GT(touches, 5);
  scene.erase("bodies");
  scene.erase("contact");
  const std::array<double, 3> weight = support();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(sum[i], weight[i], 1e-6);
  EXPECT_GT(weight[2], 1.0);
}

/// A stiff bar clamped at its first node until t = 0.5: m g, and m g L / 2 against the weight's torque.
TEST(Statics, SaysForcesAndTorquesOfSupportsAndSoDoesARunThatIsAskedTo) {
  const Folder folder;
  Json scene = Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "bar", "points": [[0, 0, 0], [1, 0, 0]], "nodes": 9, "orientation": [0, 0, 1],
       "material": {"young": 1e10, "poisson": 0.3, "density": 1000}, "section": {"type": "circular", "radius": 0.01},
       "anchors": [{"node": 0, "until": 0.5}]}],
    "forces": [{"type": "gravity", "acceleration": [0, -9.81, 0]}],
    "start": {"from": "equilibrium"},
    "simulation": {"duration": 1, "frames": 3, "supports": true}
  })");
  folder.write("scene.json", scene.dump());
  const double weight = 9.81 * 1000 * std::acos(-1.0) * 1e-4;
  const Outcome outcome = folder.run("statics scene.json --load 0.5 --out out --json --no-pictures");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json support = Json::parse(outcome.out).at("supports").at(0);
  EXPECT_EQ(support.at("anchor"), "/curve_pairs/0/anchors/0");
  EXPECT_NEAR(support.at("force")[1].get<double>() / weight, 0.5, 1e-6);
  EXPECT_NEAR(support.at("torque")[2].get<double>() / weight, 0.25, 1e-4);
  const auto found = rows_of(bytes_of(folder / "out/supports.csv"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0][5], support.at("force")[1].get<double>());
  EXPECT_EQ(found[0][9], support.at("torque")[2].get<double>());

  ASSERT_EQ(folder.run("run scene.json --out moved --no-pictures").code, 0);
  const std::string table = bytes_of(folder / "moved/supports.csv");
  EXPECT_EQ(table.substr(0, table.find('\n')), "time,anchor,rod,node,fx,fy,fz,tx,ty,tz");
  const auto moved = rows_of(table);
  ASSERT_EQ(moved.size(), 3U);
  EXPECT_EQ(std::vector(moved[0].begin(), moved[0].begin() + 4), (std::vector<double>{0, 0, 0, 0}));
  EXPECT_NEAR(moved[0][5] / weight, 1.0, 1e-5);
  EXPECT_NEAR(moved[0][9] / weight, 0.5, 1e-4);
  EXPECT_EQ(std::vector(moved[2].begin(), moved[2].end()),
            (std::vector<double>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0}));

  scene["simulation"].erase("supports");
  folder.write("scene.json", scene.dump());
  ASSERT_EQ(folder.run("run scene.json --out plain --no-pictures").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "plain/supports.csv"));
  EXPECT_EQ(bytes_of(folder / "plain/trajectory.csv"), bytes_of(folder / "moved/trajectory.csv"));
}

}  // namespace
}  // namespace tendril::test
