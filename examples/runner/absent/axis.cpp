#include "commands.h"
#include "rig/of_mesh.h"

#include <tendril/base/error.h>

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

std::vector<RigCurve> find_curves(const bind::PolygonMesh&, const std::string& path, const RigAxes&,
                                  std::string&) {
  throw InvalidInput(path, "no axes: this program was built without TENDRIL_AXIS",
                     "--axis with a curve file");
}

}  // namespace tendril::runner
