#include <tendril/bind/import.h>
#include <tendril/curve/closest_point.h>

#include <cmath>
#include <cstdio>

#include "bench/binding/peers.h"
#include "bench/binding/sections.h"
#include "bench/clock.h"

namespace tendril::bench {
namespace {

constexpr double kLength = 10.0;

/// A slight wave, or a trochoid whose neighbouring loops almost touch.
BSpline make_curve(bool loops, int spans) {
  const int count = spans + 3;
  const int turns = spans <= 8 ? 2 : spans <= 32 ? 5 : 16;
  std::vector<Vec3> u;
  for (int i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) / (count - 1);
    const double angle = 6.283185307179586 * turns * s;
    const double radius = loops ? 0.9 * kLength / turns : 0.0;
    u.emplace_back(kLength * s + radius * std::sin(angle),
                   loops ? -radius * std::cos(angle) : 0.05 * kLength * std::sin(6.0 * s),
                   0.02 * kLength * std::cos(5.0 * s));
  }
  return {KnotVector::uniform(3, count), u};
}

/// The vertices of two animals, the longest side of each laid along the curve.
std::vector<Vec3> animals(const Settings& settings) {
  std::vector<Vec3> points;
  for (const char* name : {"diplodocus.off", "armadillo.off"}) {
    const bind::PolygonMesh mesh = bind::read_mesh(settings.meshes + "/" + name);
    Vec3 low = mesh.points.front(), high = low;
    for (const Vec3& p : mesh.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    Eigen::Index along = 0;
    const double longest = (high - low).maxCoeff(&along);
    for (const Vec3& p : mesh.points) {
      const Vec3 from_middle = (p - 0.5 * (low + high)) * (kLength / longest);
      points.emplace_back(from_middle[along] + 0.5 * kLength, from_middle[(along + 1) % 3],
                          from_middle[(along + 2) % 3]);
    }
  }
  return points;
}

struct Answer {
  double seconds;      ///< a point
  std::size_t points;  ///< that there was time for
  std::size_t longer, none;
};

/// A peer on every k-th point, whose time would otherwise be minutes.
Answer ask(Projector& peer, const std::vector<Vec3>& points, const std::vector<double>& ours, double budget,
           const std::string& name, Settings& settings) {
  Answer answer{0, 0, 0, 0};
  constexpr std::size_t kSteps = 50;  // an even sample, dense where there is time
  double spent = 0.0;
  for (std::size_t first = 0; first < kSteps && spent < budget; ++first) {
    std::vector<double> found;
    const double begin = cpu_seconds();
    for (std::size_t i = first; i < points.size(); i += kSteps) found.push_back(peer.distance(points[i]));
    spent += cpu_seconds() - begin;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::size_t i = first + k * kSteps;
      answer.none += !std::isfinite(found[k]);
      answer.longer += std::isfinite(found[k]) && found[k] > ours[i] + 1e-6 * kLength;
      if (found[k] < ours[i] - 1e-7 * kLength)
        settings.broken.push_back(name + " found a nearer point than ours, by " +
                                  text("%.1e", ours[i] - found[k]));
    }
    answer.points += found.size();
  }
  answer.seconds = spent / static_cast<double>(answer.points);
  return answer;
}

/// Of a point, asked for one by one, each with its neighbour's parameter as a hint.
double seconds_alone(const CurveProjector& projector, const std::vector<Vec3>& points,
                     const Settings& settings) {
  return fastest(settings.quick ? 3 : 15,
                 [&] {
                   double hint = 0.5;
                   for (const Vec3& p : points) hint = projector.nearest(p, hint).t;
                 }) /
         static_cast<double>(points.size());
}

}  // namespace

OrderedJson projection_section(Settings& settings) {
  heading("projection",
          "microseconds for the nearest point on a cubic, two animals' vertices in mesh order, all in one "
          "call or one by one; a peer's: how many times ours in one call (wrong answers: farther than 1e-6 "
          "of the length, or none)");
  const std::vector<Vec3> points = animals(settings);
  const auto peers_of = [](const BSpline& curve) {
    std::vector<ProjectionPeer> peers;
    peers.push_back(occt_projector(curve));
    peers.push_back(sisl_s1953(curve));
    peers.push_back(sisl_s1957(curve));
    return peers;
  };
  std::vector<double> product(3, 1.0);
  std::vector<ProjectionPeer> names;
  Table table({"curve, spans", "ours", "one by one", "OCCT", "s1953", "s1957"});
  OrderedJson out;
  int cases = 0;
  for (const bool loops : {false, true})
    for (const int spans : {8, 32, 128}) {
      const BSpline curve = make_curve(loops, spans);
      const CurveProjector projector(curve);
      const double alone = seconds_alone(projector, points, settings);
      std::vector<Projection> found;
      const double seconds = fastest(settings.quick ? 3 : 15, [&] { found = projector.nearest(points); }) /
                             static_cast<double>(points.size());
      std::vector<double> ours;
      for (const Projection& at : found) ours.push_back(at.distance);
      const std::string name = std::string(loops ? "loops " : "gentle ") + std::to_string(spans);
      std::vector<std::string> row{name, text("%.3f", 1e6 * seconds), text("%.3f", 1e6 * alone)};
      OrderedJson entry{{"curve", name}, {"us", 1e6 * seconds}, {"us_alone", 1e6 * alone}};
      names = peers_of(curve);
      for (std::size_t k = 0; k < names.size(); ++k) {
        if (!names[k].projector) {
          row.push_back("-");
          continue;
        }
        const Answer a =
            ask(*names[k].projector, points, ours, settings.quick ? 0.2 : 1.5, names[k].name, settings);
        const double ratio = a.seconds / seconds;
        const double wrong = 100.0 * static_cast<double>(a.longer + a.none) / static_cast<double>(a.points);
        row.push_back(text("%.1f", ratio) + text(" (%.2f %%)", wrong));
        entry[names[k].name] = {
            {"us", 1e6 * a.seconds}, {"ratio", ratio}, {"points", a.points}, {"wrong_percent", wrong}};
        product[k] *= ratio;
      }
      table.row(row);
      out["curves"].push_back(entry);
      ++cases;
    }
  table.print();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!names[k].projector) {
      std::printf("%s\n", names[k].name.c_str());
      continue;
    }
    const double mean = std::pow(product[k], 1.0 / cases);
    std::printf("%s: %.1f times ours in the geometric mean (asked: %.0f)\n", names[k].name.c_str(), mean,
                names[k].goal);
    out["mean"][names[k].name] = mean;
  }
  return out;
}

}  // namespace tendril::bench
