// Command lines with odd meshes, curves, poses and options: whatever is asked, the program ends by itself
// with 0, 1 or 2. Each runs in a process of its own, so that a signal is seen.
//   command_sweep [--seed S] [--count N] [--keep FOLDER]
// Exit 1 where one ended otherwise or took more than a minute; what it was given stays in FOLDER, by number.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "commands.h"
#include "runner/odd_files.h"

namespace tendril::test {
namespace {

constexpr unsigned kSeconds = 60;

class Lines {
 public:
  Lines(const std::filesystem::path& folder, std::uint64_t seed) : folder_(folder), random_(seed) {}

  std::vector<std::string> next() {
    const std::string mesh = a_mesh("mesh");
    Curve rest = any_curve(random_);
    Curve pose = any_pose(rest, random_);
    for (int k = random_.integer(3); k > 0; --k)
      disturb(random_.integer(2) == 0 ? rest.points : pose.points, random_);
    const std::string axis = write("axis.json", curve_text(rest)),
                      posed = write("pose.json", curve_text(pose));
    int command = random_.integer(13);
    // Axes of needles take seconds: three of four lines give their turn to the readers.
    if ((command == kAxis || command == kRig) && random_.integer(4) != 0) command = kCheck;
    switch (command) {
      case kCheck:
        return with({"check", mesh}, {"--json", "--strict"});
      case 1:
        return with({"repair", mesh, "--out", out(random_.integer(2) ? "out.off" : "out.ply")},
                    {"--json", "--keep-points", "--keep-degenerate", "--keep-orientation",
                     "--merge-distance=" + number(random_)});
      case kAxis:
        return with({"axis", mesh, "--out", out("out.json"), "--time-limit=5"},
                    {"--close", "--largest-part", "--json", "--prune=" + number(random_),
                     "--spacing=" + number(random_), "--tolerance=" + number(random_)});
      case 3:
        return with({"bind", mesh, "--axis", axis},
                    {"--pose=" + posed, "--nearest", "--json", "--band=" + number(random_)});
      case 4:
      case 5:
        return with({"deform", mesh, "--axis", axis, "--pose", posed, "--out", out("out.ply")},
                    {"--nearest", "--equal-length", "--json", "--band=" + number(random_)});
      case 6:
        return with({"pose", axis, "--out", out("out.json"), "--bend", number(random_)},
                    {"--twist=" + number(random_)});
      case 7:
        return with({"render", mesh, "--out", out("out.png"), "--size", "48x32", "--samples", "1"},
                    {"--axis=" + axis, "--view=" + number(random_) + "," + number(random_)});
      case kRig:
        return with({"rig", mesh, "--out", out("out.json")},
                    {"--close", "--largest-part", "--wind=" + number(random_), "--size=" + number(random_),
                     "--material=steel"});
      case 9:
        return with({"run", write("scene.json", scene_text(rest, "mesh." + extension_, random_)), "--out",
                     out("run"), "--no-pictures"},
                    {"--nearest", "--no-frames", "--double", "--json"});
      case 10:
        return with({"statics", write("scene.json", scene_text(rest, "mesh." + extension_, random_)),
                     "--work-limit=200"},
                    {"--load=" + number(random_), "--first-load=" + number(random_), "--json", "--nearest"});
      case 11:
        return with({"collide", mesh, random_.integer(2) ? queries() : a_mesh("other")},
                    {"--json", "--axis=" + axis, "--pose=" + posed, "--nearest"});
      default:
        return with({"project", axis, write("points.csv", csv())}, {"--json"});
    }
  }

 private:
  static constexpr int kCheck = 0, kAxis = 2, kRig = 8;

  std::string out(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << damaged(text, random_);
    return out(name);
  }
  std::string a_mesh(const std::string& name) {
    Mesh mesh = plain_mesh(random_);
    for (int k = random_.integer(4); k > 0; --k) disturb(mesh, random_);
    const char* extensions[] = {"off", "ply", "obj"};
    extension_ = extensions[random_.integer(3)];
    return write(name + "." + extension_, mesh_text(mesh, extension_));
  }
  std::string csv() {
    std::string text = "x,y,z\n";
    for (int k = 0; k < 5; ++k) {
      const std::string x = number(random_), y = number(random_);
      text += x + "," + y + "," + number(random_) + "\n";
    }
    return text;
  }
  std::string queries() {
    std::vector<Vec3> points = line(3);
    disturb(points, random_);
    const std::string p = list(points);
    return write("queries.json", R"({"version": 1, "points": )" + p + R"(, "triangles": [)" + p +
                                     R"(], "spheres": [{"centre": [0, 0, 0], "radius": )" + number(random_) +
                                     "}]}");
  }
  std::vector<std::string> with(std::vector<std::string> line, const std::vector<std::string>& options) {
    line.insert(line.begin(), "tendril");
    for (const std::string& option : options)
      if (random_.integer(4) == 0) line.push_back(option);
    return line;
  }

  std::filesystem::path folder_;
  Random random_;
  std::string extension_;
};

/// How the program ended: its exit code, or minus the signal.
int run(const std::vector<std::string>& line) {
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
    alarm(kSeconds);
    std::vector<const char*> argv;
    for (const std::string& word : line) argv.push_back(word.c_str());
    _exit(runner::run_program(static_cast<int>(argv.size()), argv.data()));
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

int sweep(std::uint64_t seed, int count, const std::filesystem::path& keep) {
  std::map<std::string, std::map<int, int>> by_command;
  int wrong = 0;
  std::string name = (std::filesystem::temp_directory_path() / "tendril-XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  for (int k = 0; k < count; ++k) {
    Lines lines(folder, seed * 1'000'003 + static_cast<std::uint64_t>(k));
    const std::vector<std::string> line = lines.next();
    const int end = run(line);
    ++by_command[line[1]][end];
    if (end < 0 || end > 2) {
      ++wrong;
      std::cout << (end < 0 ? "signal " : "exit ") << std::abs(end) << ", number " << k << ':';
      for (const std::string& word : line) std::cout << ' ' << word;
      std::cout << std::endl;
      if (!keep.empty()) {
        std::filesystem::create_directories(keep);
        std::filesystem::copy(folder, keep / std::to_string(k), std::filesystem::copy_options::recursive);
      }
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder)) std::filesystem::remove_all(entry);
  }
  std::filesystem::remove_all(folder);
  for (const auto& [command, counts] : by_command) {
    std::cout << command << ':';
    for (const auto& [end, times] : counts) std::cout << "  " << times << " times " << end;
    std::cout << '\n';
  }
  std::cout << count << " command lines, seed " << seed << ": " << wrong
            << " ended by a signal or another exit code\n";
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tendril::test

int main(int argc, char** argv) {
  CLI::App app{"Command lines with odd files and options end with 0, 1 or 2"};
  std::uint64_t seed = 1;
  int count = 100'000;
  std::string keep;
  app.add_option("--seed", seed);
  app.add_option("--count", count);
  app.add_option("--keep", keep, "folder for what ended otherwise");
  CLI11_PARSE(app, argc, argv);
  return tendril::test::sweep(seed, count, keep);
}
