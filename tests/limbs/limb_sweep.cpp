/// Is each point of a skin bound to the limb that ways through the body lead to, and does no pose crumple it?
///
///     limb_sweep [--seed S] [--count N] [--meshes DIR] [--only NAME] [--cells C] [--joints R] [--band B]
///                [--zones PERCENT] [--splits 1]
///
/// N generated bodies of five kinds in turn, then the closed meshes of DIR on the axes that are found in
/// them. A point is bound to the limb with the most of its weight. It is judged where it is farther than R =
/// 2 radii of the body from each joint (the skin beside a joint is one away), and wrong where the way through
/// the body to another limb's axis is shorter by more than a tenth, by which ways along voxels are too long,
/// and two voxels. There are C = 128 voxels along the longest side.
///
/// Then each limb in turn is bent by 30, 60 and 120 degrees. Printed is the largest share of the skin that a
/// pose spoils, and in brackets what of it is no matter of course: not where the skin is within a fifth of
/// the radius of the centre of curvature of its own posed axis, nor within three radii of where the axis of a
/// handle is cut open, which bending one half of tears apart.
///
/// With --splits 1, edges are split at their middles once and again, and the mesh bound anew: how far that
/// moves the points of the first mesh, over its diagonal, at 60 degrees.
///
/// Fails where nothing was judged; where a point is wrong; where at 60 degrees the share in brackets is above
/// 0.1 %, or PERCENT; or where the first split moves a point by more than 0.1 % of the diagonal, or the
/// second by more than a quarter of the first.
#include <tendril/bind/binding.h>
#include <tendril/bind/distortion.h>
#include <tendril/bind/import.h>
#include <tendril/bind/judge.h>
#ifdef TENDRIL_WITH_AXIS
#include <tendril/axis/find_axis.h>
#endif

#include <cstdio>
#include <cstdlib>

#include "limbs/bodies.h"
#include "limbs/ways_through_body.h"
#include "support/numbers.h"

namespace tendril::test {
namespace {

struct Options {
  unsigned long seed = 1;
  int count = 10;
  int cells = 128;
  double band = 0.5;
  double zones = 1e-3;
  double joints = 2.0;
  bool splits = false;
  std::string only, meshes;
};

struct Found {
  std::size_t points = 0, judged = 0, wrong = 0;
  double spoilt[3]{}, crumpled[3]{};
  double moved[2]{};  ///< by the first and the second split, over the diagonal
};

std::uint32_t limb_of(const bind::Binding& binding, std::size_t point, std::size_t limbs) {
  std::vector<double> weight(limbs, 0.0);
  for (const bind::Share& share : binding.shares(point)) weight[share.pair] += share.weight;
  return static_cast<std::uint32_t>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

/// Whether a bend brings a point so near to the centre of its axis' curvature that the skin folds there, if
/// bound by the nearest point alone: closer than a fifth of the radius.
bool within_bend(const bind::Binding& binding, const std::vector<CurvePair>& posed, std::size_t point) {
  for (const bind::Share& share : binding.shares(point)) {
    const CurvePair& pair = posed[share.pair];
    const double t = share.record.t;
    const Vec3 first = pair.primary().derivative(t), second = pair.primary().derivative(t, 2);
    const Vec3 curvature = (second - first * first.dot(second) / first.squaredNorm()) / first.squaredNorm();
    if ((from_axial(pair, share.record) - pair.primary().value(t)).dot(curvature) > 0.8) return true;
  }
  return false;
}

bool near_joint(const std::vector<Limb>& limbs, const Vec3& p, double radii) {
  return std::any_of(limbs.begin(), limbs.end(), [&](const Limb& limb) {
    return limb.parent >= 0 && (limb.p[0] - p).norm() <= radii * limb.radius;
  });
}

Found judge(const Body& body, const Options& options) {
  Found found;
  const std::vector<CurvePair> rest = pairs_of(body.limbs);
  const bind::Binding binding(rest, body.mesh, {.band = options.band});
  const WaysThroughBody through(body.mesh, options.cells);
  std::vector<std::vector<double>> way;
  for (const CurvePair& pair : rest) {
    std::vector<Vec3> seeds;
    const double first = pair.knots().start(), end = pair.knots().end();
    for (int i = 0; i <= 1000; ++i) seeds.push_back(pair.primary().value(first + (end - first) * i / 1000));
    const std::vector<float> cells = through.from(seeds);
    std::vector<double>& of_points = way.emplace_back();
    for (std::size_t i = 0; i < body.mesh.points.size(); ++i) of_points.push_back(through.at(cells, i));
  }
  found.points = body.mesh.points.size();
  std::vector<std::vector<std::size_t>> wrong(rest.size(), std::vector<std::size_t>(rest.size(), 0));
  for (std::size_t i = 0; i < found.points; ++i) {
    if (near_joint(body.limbs, body.mesh.points[i], options.joints)) continue;
    ++found.judged;
    const std::uint32_t is = limb_of(binding, i, rest.size());
    std::size_t should = 0;
    for (std::size_t l = 1; l < rest.size(); ++l)
      if (way[l][i] < way[should][i]) should = l;
    if (!(way[is][i] <= 1.1 * way[should][i] + 2.0 * through.cell())) ++found.wrong, ++wrong[is][should];
  }
  for (std::size_t is = 0; is < rest.size(); ++is)
    for (std::size_t should = 0; should < rest.size(); ++should)
      if (wrong[is][should] > 0)
        std::printf("    %zu points of limb %zu are bound to limb %zu\n", wrong[is][should], should, is);
  std::vector<Vec3> out(found.points);
  const double angles[]{30.0, 60.0, 120.0};
  for (std::size_t l = 0; l < rest.size(); ++l)
    for (std::size_t a = 0; a < 3; ++a) {
      const std::vector<CurvePair> posed = bent(body.limbs, l, angles[a] * kPi / 180.0);
      binding.update(posed, out);
      const bind::Distortion d = bind::measure_distortion(binding, rest, body.mesh, posed, out);
      const auto spared = [&](std::uint32_t face) {
        const auto corners = body.mesh.face(face);
        return std::any_of(corners.begin(), corners.end(),
                           [&](std::uint32_t i) { return within_bend(binding, posed, i); });
      };
      double crumpled = 0.0;
      for (const bind::SpoiltZone& zone : d.zones) {
        std::size_t free = 0;
        for (const std::uint32_t face : zone.faces) free += !spared(face);
        const bool torn = std::any_of(body.cuts.begin(), body.cuts.end(), [&](const Cut& cut) {
          return (cut.p - zone.centre).norm() <= 3.0 * cut.radius + zone.radius;
        });
        if (free == 0 || torn) continue;
        crumpled += zone.area;
        if (a == 1)
          std::printf(
              "    limb %zu bent by 60: %.4f %% of the area at %.3g %.3g %.3g, %zu faces, %zu not within the "
              "bend\n",
              l, 100.0 * zone.area, zone.centre.x(), zone.centre.y(), zone.centre.z(), zone.faces.size(),
              free);
      }
      found.spoilt[a] = std::max(found.spoilt[a], d.spoilt);
      found.crumpled[a] = std::max(found.crumpled[a], crumpled);
    }
  return found;
}

/// How far points of the mesh are from where they are when bound with the edges split once, and those from
/// twice, each limb bent by 60 degrees; of the diagonal, the most.
void split(const Body& body, const Options& options, Found& found) {
  const std::vector<CurvePair> rest = pairs_of(body.limbs);
  const std::size_t points = body.mesh.points.size();
  std::vector<std::vector<Vec3>> before(rest.size());
  bind::PolygonMesh mesh = body.mesh;
  for (int k = 0; k <= 2; ++k) {
    if (k > 0) mesh = bind::split_at_middles(mesh);
    const bind::Binding binding(rest, mesh, {.band = options.band, .threads = 2});
    std::vector<Vec3> out(mesh.points.size());
    for (std::size_t l = 0; l < rest.size(); ++l) {
      binding.update(bent(body.limbs, l, kPi / 3.0), out);
      for (std::size_t i = 0; k > 0 && i < points; ++i)
        found.moved[k - 1] = std::max(found.moved[k - 1], (out[i] - before[l][i]).norm());
      before[l].assign(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(points));
    }
  }
  for (double& moved : found.moved) moved /= bind::bounding_diagonal(body.mesh.points);
}

bool tell(const Body& body, const Options& options, std::size_t& judged) {
  if (!options.only.empty() && body.name.find(options.only) == std::string::npos) return true;
  Found f = judge(body, options);
  if (options.splits) split(body, options, f);
  judged += f.judged;
  std::printf("%-18s %7zu points %3zu limbs  judged %5.1f %%  wrong %5zu", body.name.c_str(), f.points,
              body.limbs.size(), 100.0 * double(f.judged) / double(f.points), f.wrong);
  for (std::size_t a = 0; a < 3; ++a)
    std::printf("  %s %.4f (%.4f)%s", a == 0 ? "spoilt" : "", 100.0 * f.spoilt[a], 100.0 * f.crumpled[a],
                a == 2 ? " %" : "");
  if (options.splits) std::printf("  splits move %.1e, %.1e", f.moved[0], f.moved[1]);
  std::printf("\n");
  std::fflush(stdout);
  return f.wrong == 0 && f.crumpled[1] <= options.zones && f.moved[0] <= 1e-3 &&
         f.moved[1] <= std::max(1e-9, 0.25 * f.moved[0]);
}

#ifdef TENDRIL_WITH_AXIS
Body body_of(const std::string& folder, const std::string& name) {
  Body body{name, bind::read_mesh(folder + "/" + name + ".off"), {}, {}};
  const axis::AxisTree tree = axis::find_axis(body.mesh);
  for (const axis::AxisCurve& curve : tree.curves) {
    Limb limb{curve.points, curve.orientation, -1, 0, 0.0};
    if (curve.joint) {
      limb.parent = static_cast<int>(curve.joint->parent), limb.node = curve.joint->node;
      limb.radius = tree.curves[curve.joint->parent].radius[limb.node];
    }
    for (const Vec3& cut : tree.report.cuts)
      for (const bool last : {false, true})
        if ((cut - (last ? curve.points.back() : curve.points.front())).norm() < 1e-9)
          body.cuts.push_back({cut, last ? curve.radius.back() : curve.radius.front()});
    body.limbs.push_back(std::move(limb));
  }
  return body;
}
#endif

int sweep(const Options& options) {
  int bad = 0;
  std::size_t judged = 0;
  Random random(options.seed);
  for (int i = 0; i < options.count; ++i) bad += !tell(make_body(i % kBodyKinds, random), options, judged);
#ifdef TENDRIL_WITH_AXIS
  if (!options.meshes.empty())
    for (const char* name : {"diplodocus", "cactus", "elephant", "armadillo", "camel", "hand", "dino", "bear",
                             "homer", "triceratops", "cow", "bull"})
      if (options.only.empty() || options.only == name)
        bad += !tell(body_of(options.meshes, name), options, judged);
#endif
  return bad == 0 && judged > 0 ? 0 : 1;
}

}  // namespace
}  // namespace tendril::test

int main(int count, char** words) {
  tendril::test::Options options;
  bool known = count % 2 == 1;
  for (int i = 1; known && i < count; i += 2) {
    const std::string word = words[i];
    const char* value = words[i + 1];
    if (word == "--seed")
      options.seed = std::strtoul(value, nullptr, 10);
    else if (word == "--count")
      options.count = std::atoi(value);
    else if (word == "--cells")
      options.cells = std::atoi(value);
    else if (word == "--band")
      options.band = std::atof(value);
    else if (word == "--splits")
      options.splits = std::atoi(value) != 0;
    else if (word == "--zones")
      options.zones = 0.01 * std::atof(value);
    else if (word == "--joints")
      options.joints = std::atof(value);
    else if (word == "--only")
      options.only = value;
    else if (word == "--meshes")
      options.meshes = value;
    else
      known = false;
  }
  if (!known) {
    std::fprintf(stderr, "limb_sweep: an option that it does not know, or one without a value\n");
    return 2;
  }
  return tendril::test::sweep(options);
}
