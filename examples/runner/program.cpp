#include "commands.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <iostream>
#include <vector>

namespace tendril::runner {
namespace {

int call(const Command& command) {
  try {
    const int code = command.run();
    std::cout.flush();
    return code;
  } catch (const Error& error) {
    std::cerr << "tendril: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "tendril: " << error.what() << '\n';
    return kNoSuccess;
  }
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  CLI::App app{"Deforms surface meshes by axial curve-pairs, and moves the curve-pairs by rod dynamics"};
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done; 1 a numerical outcome that is not success; 2 bad input.");
  const std::vector<Command> commands{run_command(app),     axis_command(app),    deform_command(app),
                                      project_command(app), check_command(app),   bind_command(app),
                                      render_command(app),  repair_command(app),  report_command(app),
                                      statics_command(app), collide_command(app), accuracy_command(app),
                                      pose_command(app),    rig_command(app)};
  const auto is_asked = [&](const Command& command) { return command.app->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(commands.begin(), commands.end(), is_asked)) {
    std::cerr << "tendril: '" << argv[1] << "' is no subcommand; expected one of";
    for (const Command& command : commands) std::cerr << ' ' << command.app->get_name();
    std::cerr << '\n';
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  for (const Command& command : commands) {
    if (command.app->parsed()) return call(command);
  }
  return kBadInput;
}

}  // namespace tendril::runner
