#include "commands.h"

#include <tendril/base/error.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

namespace tendril::runner {
namespace {

constexpr const char* kProgram = "tendril_accuracy";

/// The suite is a program of its own: what it compares tendril with is no need of this one, and partly under
/// the GPL. It stands beside this program, or where the shell finds programs; it takes this one's place.
int call_suite(const std::vector<std::string>& arguments) {
  std::error_code unknown;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::filesystem::path beside = self.parent_path() / kProgram;
  const std::string program = !unknown && std::filesystem::exists(beside) ? beside.string() : kProgram;
  std::vector<char*> words{const_cast<char*>(kProgram)};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execvp(program.c_str(), words.data());
  throw FileError(program, std::string(std::strerror(errno)) +
                               "; it is built with the tests (TENDRIL_TESTS) and installed as 'accuracy'");
}

}  // namespace

Command accuracy_command(CLI::App& parent) {
  auto* app = parent.add_subcommand(
      "accuracy", "The collision accuracy suite: errors and run times of tendril's tests and others'");
  app->set_help_flag();
  app->prefix_command();
  return {app, [app] { return call_suite(app->remaining()); }};
}

}  // namespace tendril::runner
