#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The subcommands of the program. Exit codes: 0 done; 1 a numerical outcome that is not success, with its
/// reason; 2 bad input, with its place and what was expected on standard error.
namespace tendril::runner {

enum ExitCode : int { kDone = 0, kNoSuccess = 1, kBadInput = 2 };

/// A registered subcommand, and what to call when it was asked for.
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

Command run_command(CLI::App& parent);
Command deform_command(CLI::App& parent);
Command pose_command(CLI::App& parent);
Command project_command(CLI::App& parent);
Command check_command(CLI::App& parent);
Command axis_command(CLI::App& parent);
Command bind_command(CLI::App& parent);
Command render_command(CLI::App& parent);
Command accuracy_command(CLI::App& parent);
Command collide_command(CLI::App& parent);
Command repair_command(CLI::App& parent);
Command rig_command(CLI::App& parent);
Command report_command(CLI::App& parent);
Command statics_command(CLI::App& parent);

/// Throws InvalidInput naming the option where a file that it asks for is the one of --out.
void require_other_file(const std::string& option, const std::string& path, const std::string& out);

/// Refuses names that say another format than PNG.
void expect_png(CLI::Option* option);

/// What --threads asks for; 0 means all the machine has.
int thread_count(int asked);

/// The whole program; what main does.
int run_program(int argc, const char* const* argv);

}  // namespace tendril::runner
