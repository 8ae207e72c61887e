#include "commands.h"

#include <iostream>

namespace tendril::runner {

Command collide_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("collide", "What meets a mesh, exactly: left out of this build");
  app->allow_extras();
  return {app, [] {
            std::cerr << "tendril: collide: this program was built without TENDRIL_EXACT\n";
            return static_cast<int>(kBadInput);
          }};
}

}  // namespace tendril::runner
