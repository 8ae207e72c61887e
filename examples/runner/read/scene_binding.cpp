#include "read/scene_binding.h"

#include <tendril/curve/fit.h>

#include <algorithm>

namespace tendril::runner {
namespace {

CurvePair rest_pair(const SceneFile& file, const Rod& rod) {
  const int degree = std::min(file.options.degree, static_cast<int>(rod.p.size()) - 1);
  const Interpolator fit(degree, rod.p, file.options.parametrisation);
  return {fit.knots(), fit.solve(rod.p), fit.solve(rod.q)};
}

}  // namespace

bind::Binding bind_scene(const SceneFile& file, const bind::PolygonMesh& mesh, bind::BindMode mode,
                         int threads) {
  std::vector<CurvePair> rest;
  for (const std::size_t k : file.bound_to) rest.push_back(rest_pair(file, file.scene.rods[k]));
  try {
    return {rest, mesh, bind::BindOptions{.mode = mode, .threads = threads}};
  } catch (const InvalidInput& error) {
    throw InvalidInput(file.mesh, error.place() + ": " + error.reason(), error.expected());
  }
}

bind::BindMode mode_of(const SceneFile& file, bool continuous, bool nearest) {
  if (continuous && nearest) throw InvalidInput("--nearest", "with --continuous", "one of the two");
  const bool smooth = continuous || (file.bound_to.size() > 1 && !nearest);
  return smooth ? bind::BindMode::continuous : bind::BindMode::nearest;
}

}  // namespace tendril::runner
