#include "commands.h"

#include <iostream>

namespace tendril::runner {

Command axis_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("axis", "Finds the axes of a mesh: left out of this build");
  app->allow_extras();
  return {app, [] {
            std::cerr << "tendril: axis: this program was built without TENDRIL_AXIS\n";
            return static_cast<int>(kBadInput);
          }};
}

}  // namespace tendril::runner
