#include <tendril/bind/binding.h>
#include <tendril/bind/import.h>
#include <tendril/curve/fit.h>

#include <cstdio>
#include <fstream>

#include "bench/binding/sections.h"
#include "bench/clock.h"

namespace tendril::bench {
namespace {

/// The curve-pairs of the dinosaur's scene.
std::vector<CurvePair> tree() {
  std::ifstream in(std::string(TENDRIL_SOURCE_DIR) + "/examples/scenes/diplodocus_tree.json");
  const OrderedJson scene = OrderedJson::parse(in, nullptr, true, true);
  std::vector<CurvePair> out;
  for (const OrderedJson& curve : scene.at("curve_pairs")) {
    std::vector<Vec3> p, q;
    for (const OrderedJson& point : curve.at("points")) {
      p.emplace_back(point[0].get<double>(), point[1].get<double>(), point[2].get<double>());
      q.push_back(p.back() + Vec3(0.02, 0.01, 0.05));
    }
    const Interpolator fit(3, p);
    out.emplace_back(fit.knots(), fit.solve(p), fit.solve(q));
  }
  return out;
}

}  // namespace

OrderedJson tree_section(Settings& settings) {
  heading(
      "tree",
      "seconds to bind the dinosaur to its tree of five axes, all that has to be known of the body included; "
      "nanoseconds a vertex of an update and of its transpose");
  const bind::PolygonMesh mesh = bind::read_mesh(settings.meshes + "/diplodocus.off");
  const std::vector<CurvePair> axes = tree();
  Table table({"binding", "points", "shares", "seconds", "update", "transpose"});
  OrderedJson out;
  for (const bind::BindMode mode : {bind::BindMode::continuous, bind::BindMode::nearest}) {
    const double seconds =
        fastest(settings.quick ? 2 : 5, [&] { bind::Binding(axes, mesh, {.mode = mode}); });
    const bind::Binding binding(axes, mesh, {.mode = mode});
    const std::size_t shares = binding.report().shares;
    std::vector<Vec3> out_points(mesh.points.size());
    const double each = 1e9 / static_cast<double>(mesh.points.size());
    const double update = each * fastest_of_many(15, 0.01, [&] { binding.update(axes, out_points); });
    const double transpose =
        each * fastest_of_many(15, 0.01, [&] { (void)binding.pull_back(axes, mesh.points); });
    const char* const name = mode == bind::BindMode::nearest ? "nearest" : "continuous";
    table.row({name, std::to_string(mesh.points.size()), std::to_string(shares), text("%.2f", seconds),
               text("%.1f", update), text("%.1f", transpose)});
    out.push_back({{"binding", name},
                   {"points", mesh.points.size()},
                   {"shares", shares},
                   {"seconds", seconds},
                   {"update", update},
                   {"transpose", transpose}});
  }
  table.print();
  return out;
}

}  // namespace tendril::bench
