#include "runner/program.h"
#include "study/extrapolation.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace tendril::test {
namespace {

using Json = nlohmann::json;
using runner::Trial;

/// A short rod that swings under its weight and gusts, with a joined twig where asked for.
std::string small_scene(bool joined = false, double young = 2e5) {
  Json scene = Json::parse(full_scene());
  scene["mesh"] = nullptr;
  scene["curve_pairs"].erase(1);
  Json& stem = scene["curve_pairs"][0];
  stem["viscosity"] = 0;
  stem["material"]["young"] = young;
  scene["forces"] = Json::array({scene["forces"][0], scene["forces"][2]});
  scene["simulation"] = {{"duration", 0.5}, {"frames", 6}};
  if (joined) {
    scene["curve_pairs"].push_back({{"name", "twig"},
                                    {"points", Json::parse("[[0, 0, 0], [0.2, 0, 0.1]]")},
                                    {"nodes", 4},
                                    {"orientation", Json::parse("[0, 1, 0]")},
                                    {"material", stem["material"]},
                                    {"section", Json::parse(R"({"type": "circular", "radius": 0.03})")},
                                    {"joint", {{"curve_pair", "stem"}, {"node", 3}, {"relative", true}}}});
  }
  return scene.dump();
}

/// Time is counted in evaluations, so that nothing depends on how fast the machine is.
constexpr const char* kCounted = "report scene.json --out out --rate 1e6 ";

Json report_of(const Folder& folder, const std::string& options, int code = 0) {
  const Outcome outcome = folder.run(std::string(kCounted) + "--json " + options);
  EXPECT_EQ(outcome.code, code) << outcome.err;
  return Json::parse(outcome.out);
}

std::vector<Json> runs_of(const Json& report, const std::string& method) {
  std::vector<Json> out;
  for (const Json& run : report.at("runs"))
    if (run.at("method") == method) out.push_back(run);
  return out;
}

TEST(Report, WritesWhatItPrintsAndAPicture) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  const Outcome outcome = folder.run(std::string(kCounted) + "--json --tolerances 1e-3,1e-5 --budget 20");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Json report = Json::parse(outcome.out);
  EXPECT_EQ(report, Json::parse(bytes_of(folder / "out/report.json")));
  EXPECT_EQ(report.at("masses"), 6);
  EXPECT_NEAR(report.at("length").get<double>(), 1.0, 1e-12);
  EXPECT_TRUE(report.at("reference").at("certified"));
  EXPECT_NE(report.at("reference").at("first").at("method"),
            report.at("reference").at("second").at("method"));
  EXPECT_EQ(report.at("runs").size(), 4U * 2U + 2U * 4U);
  const std::string svg = bytes_of(folder / "out/report.svg");
  EXPECT_EQ(svg.rfind("<svg ", 0), 0U);
  for (const char* text :
       {"</svg>", ">rodas<", ">automatic<", ">verlet<", "time by evaluations [s]", "position error"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Report, GivesEveryRunItsCostAndEnergy) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  const Json report = report_of(folder, "--tolerances 1e-4,1e-6 --steps 0.004,0.002 --budget 20");
  for (const Json& run : report.at("runs")) {
    EXPECT_EQ(run.at("outcome"), "finished") << run;
    EXPECT_EQ(run.at("reason"), "");
    EXPECT_EQ(run.at("extrapolated"), false);
    EXPECT_GT(run.at("cpu_s").get<double>(), 0.0);
    EXPECT_GE(run.at("evaluations").get<double>(), run.at("steps_accepted").get<double>());
    EXPECT_LT(std::abs(run.at("energy_imbalance").get<double>()), 1e-2);
    EXPECT_GT(run.at("director_error").get<double>(), 0.0);
    EXPECT_EQ(run.contains("tolerance"), !run.contains("fixed_step"));
  }
  const Json& recommended = report.at("recommended");
  EXPECT_TRUE(recommended.contains("tolerance")) << recommended;
  const std::string sentence = report.at("recommendation");
  EXPECT_NE(sentence.find(recommended.at("method").get<std::string>()), std::string::npos) << sentence;
}

TEST(Report, ErrorsFallWithTheOrderOfEachMethod) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  const Json report =
      report_of(folder, "--tolerances 1e-3,1e-4,1e-5,1e-6 --steps 0.008,0.004,0.002,0.001 --budget 30");
  std::map<std::string, double> orders;
  for (const Json& entry : report.at("orders")) orders[entry.at("method")] = entry.at("order");
  EXPECT_NEAR(orders.at("verlet"), 2.0, 0.15);
  EXPECT_NEAR(orders.at("runge_kutta4"), 4.0, 0.3);
  EXPECT_NEAR(orders.at("rodas"), 1.0, 0.35);  // of the tolerance of a step
  for (const char* method : {"rodas", "verlet", "runge_kutta4"}) {
    double before = 1.0;
    for (const Json& run : runs_of(report, method)) {
      EXPECT_LT(run.at("position_error").get<double>(), before) << method;
      before = run.at("position_error");
    }
  }
}

TEST(Report, ErrorIsThatOfTheTrajectories) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  const Json report = report_of(folder, "--methods rodas,cash_karp --tolerances 1e-2,1e-8 --budget 20");
  // The same two runs by `run`, compared here.
  const auto last_line = [&](const char* method, double tolerance) {
    Json scene = Json::parse(small_scene());
    scene["simulation"]["method"] = method;
    scene["simulation"]["tolerance"] = tolerance;
    folder.write("one.json", scene.dump());
    EXPECT_EQ(folder.run("run one.json --out one --no-pictures --no-frames").code, 0);
    return bytes_of(folder / "one/trajectory.csv");
  };
  std::istringstream loose(last_line("rodas", 1e-2)), tight(last_line("cash_karp", 1e-8));
  std::map<double, double> squares;
  std::string a, b;
  std::getline(loose, a), std::getline(tight, b);
  while (std::getline(loose, a) && std::getline(tight, b)) {
    double time = 0, x[3], y[3];
    int rod = 0, node = 0;
    ASSERT_EQ(std::sscanf(a.c_str(), "%lf,%d,%d,%lf,%lf,%lf", &time, &rod, &node, x, x + 1, x + 2), 6);
    ASSERT_EQ(std::sscanf(b.c_str(), "%lf,%d,%d,%lf,%lf,%lf", &time, &rod, &node, y, y + 1, y + 2), 6);
    for (int k = 0; k < 3; ++k) squares[time] += (x[k] - y[k]) * (x[k] - y[k]);
  }
  double largest = 0.0;
  for (const auto& [time, square] : squares) largest = std::max(largest, std::sqrt(square / 6));
  const double told = runs_of(report, "rodas").front().at("position_error");
  EXPECT_GT(told, 1e-6);
  EXPECT_NEAR(told, largest, 0.01 * largest);
}

/// A finished run of one mass, at one place.
Trial at(Method method, double x) {
  Trial out;
  out.setting = {method, 1e-6};
  Frame frame;
  frame.x = Vec3::UnitX(), frame.y = Vec3::UnitY(), frame.z = Vec3::UnitZ();
  out.track.moments.push_back({1.0, {Vec3(x, 0, 0)}, {frame}});
  return out;
}

TEST(Certification, AsksForTwoMethodsThatAgree) {
  const runner::Agreement wanted{1e-4, 1e-3};
  EXPECT_TRUE(runner::certify(at(Method::rodas, 0), at(Method::cash_karp, 1e-4), 2.0, wanted).certified);
  const auto apart = runner::certify(at(Method::rodas, 0), at(Method::cash_karp, 3e-4), 2.0, wanted);
  EXPECT_FALSE(apart.certified);
  EXPECT_NEAR(apart.gap.position, 1.5e-4, 1e-15);
  EXPECT_NE(apart.statement.find("1.5e-04"), std::string::npos) << apart.statement;
  EXPECT_FALSE(runner::certify(at(Method::rodas, 0), at(Method::rodas, 0), 2.0, wanted).certified);
  Trial unfinished = at(Method::cash_karp, 0);
  unfinished.outcome = Trial::Outcome::refused;
  unfinished.reason = "too stiff";
  const auto alone = runner::certify(at(Method::rodas, 0), unfinished, 2.0, wanted);
  EXPECT_FALSE(alone.certified);
  EXPECT_NE(alone.statement.find("too stiff"), std::string::npos);
}

TEST(Certification, ExtrapolatesBackwardEulerFarBelowItsError) {
  const Folder folder;
  const scene::SceneFile file = scene::read_scene(folder.write("scene.json", small_scene()));
  const System system(file.scene);
  const runner::Study study(file, system);
  const auto run = runner::extrapolated_run(study, 60.0);
  ASSERT_TRUE(run.has_value());
  const Trial plain = study.run(run->trial.setting, 60.0, true),
              right = study.run({Method::cash_karp, 1e-9}, 60.0);
  ASSERT_TRUE(plain.finished() && right.finished());
  const double error = runner::distance(run->trial.track, right.track, 1.0).position;
  const double before = runner::distance(plain.track, right.track, 1.0).position;
  EXPECT_GT(before, 1e-5);
  EXPECT_LT(error, 1e-3 * before);
}

TEST(Certification, ComparesFramesToo) {
  Trial turned = at(Method::cash_karp, 0);
  Frame& frame = turned.track.moments[0].frames[0];
  frame.x = Vec3(std::cos(0.01), std::sin(0.01), 0), frame.y = Vec3(-std::sin(0.01), std::cos(0.01), 0);
  const auto reference = runner::certify(at(Method::rodas, 0), turned, 1.0, {1e-4, 1e-3});
  EXPECT_FALSE(reference.certified);
  EXPECT_NEAR(reference.gap.director, 0.01, 1e-12);
}

TEST(Certification, FailsAloudThroughTheProgram) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  const Outcome outcome =
      folder.run(std::string(kCounted) + "--tolerances 1e-2,1e-3 --target 1e-13 --budget 10");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("not certified"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("No run met 1e-13"), std::string::npos) << outcome.out;
  EXPECT_FALSE(Json::parse(bytes_of(folder / "out/report.json")).at("reference").at("certified"));
}

TEST(Report, ShowsRefusedRunsWithTheirReason) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  const Json report = report_of(folder, "--methods verlet --steps 0.5,0.001 --tolerances 1e-4 --budget 20");
  const std::vector<Json> runs = runs_of(report, "verlet");
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].at("outcome"), "refused");
  EXPECT_EQ(runs[0].at("reason").get<std::string>().rfind("too_stiff: ", 0), 0U) << runs[0];
  EXPECT_TRUE(runs[0].at("position_error").is_null());
  EXPECT_EQ(runs[1].at("outcome"), "finished") << runs[1];
}

TEST(Report, MarksWhatItExtrapolatesAndSkipsWhatWouldTakeLonger) {
  const Folder folder;
  Json scene = Json::parse(small_scene(false, 2e9));
  scene["simulation"]["work_limit"] = 4000000000;
  folder.write("scene.json", scene.dump());
  const std::string options = "--methods cash_karp --tolerances 1e-3,1e-5 --cap 0.002 --budget 4";
  const Json report = Json::parse(folder.run("report scene.json --out out --json " + options).out);
  const std::vector<Json> runs = runs_of(report, "cash_karp");
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].at("outcome"), "capped") << runs[0];
  EXPECT_EQ(runs[0].at("extrapolated"), true);
  EXPECT_GT(runs[0].at("cpu_s").get<double>(), 0.004);
  EXPECT_EQ(runs[1].at("outcome"), "skipped");
  EXPECT_NE(runs[1].at("reason").get<std::string>().find("too long"), std::string::npos);
  EXPECT_TRUE(report.at("recommended").is_null());
  EXPECT_NE(folder.run("report scene.json --out out " + options).out.find(" ~"), std::string::npos);
}

/// A chain of hardly stretching edges that falls and swings: far moved, and far too stiff for explicit
/// methods.
std::string stiff_chain() {
  Json scene = Json::parse(full_scene());
  scene["mesh"] = nullptr;
  scene["curve_pairs"].erase(0);
  scene.erase("bound_to");
  Json& chain = scene["curve_pairs"][0];
  chain["springs"]["stretch"] = 1e12;
  chain["mass_damping"] = 0.5;
  chain["anchors"] = Json::parse(R"([{"node": 0}])");
  scene["forces"] = Json::array({scene["forces"][0]});
  scene["simulation"] = {{"duration", 0.4}, {"frames", 5}};
  return scene.dump();
}

TEST(Report, CertifiesWhatIsTooStiffForExplicitMethods) {
  const Folder folder;
  folder.write("scene.json", stiff_chain());
  const Json report = report_of(folder, "--methods cash_karp,automatic --tolerances 1e-3,1e-6 --budget 10");
  EXPECT_EQ(report.at("reference").at("second").at("method"), "backward_euler") << report.at("reference");
  EXPECT_TRUE(report.at("reference").at("certified")) << report.at("reference");
  EXPECT_EQ(runs_of(report, "cash_karp").front().at("outcome"), "refused");
  EXPECT_EQ(report.at("recommended").at("method"), "automatic");
}

TEST(Report, IsTheSameTwiceWhereTimeIsCounted) {
  const Folder folder;
  folder.write("scene.json", stiff_chain());
  const std::string options = "--methods rodas,automatic --tolerances 1e-3,1e-5 --budget 4";
  const Json once = report_of(folder, options);
  EXPECT_EQ(once, report_of(folder, options));
  EXPECT_EQ(once.at("evaluations_per_second"), 1e6);
  for (const Json& run : once.at("runs"))
    EXPECT_DOUBLE_EQ(run.at("cpu_s").get<double>(), 1e-6 * run.at("evaluations").get<double>());
}

TEST(Report, CertifiesATreeToo) {
  const Folder folder;
  folder.write("scene.json", small_scene(true));
  const Json report = report_of(folder, "--methods cash_karp,verlet --tolerances 1e-3,1e-4 --budget 30");
  EXPECT_TRUE(report.at("reference").at("certified"));
  EXPECT_EQ(report.at("masses"), 10);
}

TEST(Report, RefusesBadInput) {
  const Folder folder;
  folder.write("scene.json", small_scene());
  folder.write("file", "");
  const std::string good = "report scene.json --out out ";
  for (const std::string& arguments :
       {std::string("report missing.json --out out"), std::string("report scene.json"),
        good + "--methods leapfrog", good + "--tolerances 1e-3,-1", good + "--tolerances x",
        good + "--budget 0", good + "--rate 0", good + "--cap -1", good + "--target nan", good + "--steps 0",
        std::string("report scene.json --out file")}) {
    const Outcome outcome = folder.run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << '\n' << outcome.err;
    EXPECT_NE(outcome.err, "") << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace tendril::test
