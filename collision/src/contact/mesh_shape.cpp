#include <tendril/base/error.h>
#include <tendril/collision/box_queries.h>
#include <tendril/contact/shape.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "foot.h"

namespace tendril::contact {
namespace {

using Corners = std::array<std::uint32_t, 3>;

std::string place_of(std::size_t triangle) {
  return "mesh.triangles[" + std::to_string(triangle) + "]";
}

/// Which triangle has an edge in its direction.
class Edges {
 public:
  explicit Edges(std::span<const Corners> triangles) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (!of_.emplace(key(triangles[t], i, false), t).second)
          throw InvalidInput(place_of(t), "an edge that another triangle has in the same direction",
                             "a closed surface, oriented outward, no edge of more than two triangles");
  }
  /// The triangle beyond edge i; throws where there is none.
  std::size_t beyond(std::span<const Corners> triangles, std::size_t t, std::size_t i) const {
    const auto found = of_.find(key(triangles[t], i, true));
    if (found == of_.end())
      throw InvalidInput(place_of(t), "an edge of no other triangle", "a closed surface, oriented outward");
    return found->second;
  }

 private:
  static std::uint64_t key(const Corners& t, std::size_t i, bool back) {
    const std::uint64_t from = t[i], to = t[(i + 1) % 3];
    return back ? to << 32 | from : from << 32 | to;
  }
  std::unordered_map<std::uint64_t, std::size_t> of_;
};

/// The signed distance by the nearest point of the surface; its sign by the normal of the nearest part, at
/// edges the sum of both faces' and at corners weighted by angles [Baerentzen and Aanaes 2005]. A face's own
/// normal would not do at edges and corners: which of several faces as near is found first depends on the
/// order of the tree, and beside a sharp corner they disagree. The weights by angle, not the areas, make
/// the sign right and independent of how faces are cut.
/// In doubles alone: a force needs a distance that is continuous, not one that is exact.
class MeshShape final : public Shape {
 public:
  MeshShape(Points points, std::span<const Corners> triangles)
      : points_(points.begin(), points.end()), triangles_(triangles.begin(), triangles.end()) {
    check();
    const Edges edges(triangles_);
    set_normals(edges);
    check_corners(edges);
    if (!(volume() > 0.0)) throw InvalidInput("mesh.triangles", "inside out", "oriented outward");
    std::vector<collision::Box> boxes;
    for (std::size_t t = 0; t < triangles_.size(); ++t) boxes.push_back(collision::box_of(corners(t)));
    tree_ = collision::BoxTree(boxes);
  }

  SignedDistance at(const Vec3& x) const override {
    const Nearest nearest = nearest_to(x);
    const Vec3 away = x - nearest.foot.point, &outward = normal_of(nearest);
    const double d = away.norm(), side = away.dot(outward) < 0.0 ? -1.0 : 1.0;
    // On a face the plane's own normal has more digits than a short way from it; on an edge there is no way.
    if (nearest.foot.part == Foot::Part::face || d == 0.0)
      return {side * d, outward.normalized(), Mat3(Mat3::Zero())};
    const Vec3 n = side / d * away;
    Mat3 flat = Mat3::Identity() - n * n.transpose();
    if (nearest.foot.part == Foot::Part::edge) {
      const auto t = corners(nearest.triangle);
      const Vec3 along = (t[(nearest.foot.which + 1) % 3] - t[nearest.foot.which]).normalized();
      flat -= along * along.transpose();
    }
    return {side * d, n, flat / (side * d)};
  }

  double distance(const Vec3& x) const override {
    const Nearest nearest = nearest_to(x);
    const Vec3 away = x - nearest.foot.point;
    return away.dot(normal_of(nearest)) < 0.0 ? -away.norm() : away.norm();
  }

  double outward_radius() const override { return 0.0; }
  double extent() const override {
    double most = 0.0;
    for (const Vec3& p : points_) most = std::max(most, p.norm());
    return most;
  }

 private:
  struct Nearest {
    std::size_t triangle = 0;
    Foot foot{};
  };

  std::array<Vec3, 3> corners(std::size_t t) const {
    return {points_[triangles_[t][0]], points_[triangles_[t][1]], points_[triangles_[t][2]]};
  }

  Nearest nearest_to(const Vec3& x) const {
    Nearest best;
    double least = std::numeric_limits<double>::infinity();
    tree_.nearest([&](const collision::Box& box) { return collision::square_distance(box, x); },
                  [&] { return least * (1.0 + 0x1p-48); },
                  [&](std::size_t t) {
                    const Foot foot = foot_on(corners(t), x);
                    const double square = (x - foot.point).squaredNorm();
                    if (!(square < least)) return;
                    least = square;
                    best = {t, foot};
                  });
    return best;
  }

  const Vec3& normal_of(const Nearest& at) const {
    switch (at.foot.part) {
      case Foot::Part::corner:
        return corner_normals_[triangles_[at.triangle][at.foot.which]];
      case Foot::Part::edge:
        return edge_normals_[3 * at.triangle + at.foot.which];
      case Foot::Part::face:
        break;
    }
    return face_normals_[at.triangle];
  }

  void check() const {
    if (!all_finite(points_)) throw InvalidInput("mesh.points", "not finite", "finite points");
    if (triangles_.empty()) throw InvalidInput("mesh.triangles", "none", "a closed surface");
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (const std::uint32_t corner : triangles_[t])
        if (corner >= points_.size())
          throw InvalidInput(place_of(t), std::to_string(corner), "below " + std::to_string(points_.size()));
      const auto [a, b, c] = corners(t);
      if (!((b - a).cross(c - a).norm() > 0.0))
        throw InvalidInput(place_of(t), "three corners on a line", "triangles with an area");
    }
  }

  void set_normals(const Edges& edges) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto [a, b, c] = corners(t);
      face_normals_.push_back((b - a).cross(c - a).normalized());
    }
    corner_normals_.assign(points_.size(), Vec3::Zero());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto at = corners(t);
      for (std::size_t i = 0; i < 3; ++i) {
        edge_normals_.push_back(face_normals_[t] + face_normals_[edges.beyond(triangles_, t, i)]);
        const Vec3 next = at[(i + 1) % 3] - at[i], last = at[(i + 2) % 3] - at[i];
        const double angle = std::atan2(next.cross(last).norm(), next.dot(last));
        corner_normals_[triangles_[t][i]] += angle * face_normals_[t];
      }
    }
  }

  /// The triangles about a corner, gone round, must be all that have it: where two parts meet in a point, the
  /// normal there is a mean over both, and says nothing of either's inside.
  void check_corners(const Edges& edges) const {
    std::vector<std::size_t> has(points_.size(), 0), gone(points_.size(), 0);
    for (const Corners& t : triangles_)
      for (const std::uint32_t corner : t) ++has[corner];
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t corner = triangles_[t][i];
        if (gone[corner] > 0) continue;
        std::size_t now = t, at = i;
        do {
          ++gone[corner];
          now = edges.beyond(triangles_, now, at);
          at = static_cast<std::size_t>(std::find(triangles_[now].begin(), triangles_[now].end(), corner) -
                                        triangles_[now].begin());
        } while (now != t && gone[corner] <= has[corner]);
        if (gone[corner] != has[corner])
          throw InvalidInput("mesh.points[" + std::to_string(corner) + "]",
                             "two parts of the surface meet there", "a surface that does not touch itself");
      }
  }

  /// Six times it.
  double volume() const {
    double sum = 0.0;
    const Vec3 origin = points_[triangles_[0][0]];
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto [a, b, c] = corners(t);
      sum += (a - origin).dot((b - origin).cross(c - origin));
    }
    return sum;
  }

  std::vector<Vec3> points_;
  std::vector<Corners> triangles_;
  std::vector<Vec3> face_normals_, edge_normals_, corner_normals_;
  collision::BoxTree tree_;
};

}  // namespace

ShapePtr mesh(Points points, std::span<const std::array<std::uint32_t, 3>> triangles) {
  return std::make_shared<MeshShape>(points, triangles);
}

}  // namespace tendril::contact
