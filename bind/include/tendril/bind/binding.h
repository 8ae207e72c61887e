#pragma once

#include <tendril/bind/bind_options.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/curve_pair.h>

#include <cstdint>
#include <span>
#include <vector>

namespace tendril::bind {

/// Points bound to curve-pairs: each to its nearest point on the primary curves, as an axial record
/// (thesis 2.2), or to several places of them with weights. Every record gives the rest shape back, whatever
/// its place, so any weights that sum to 1 do. Immutable once made, works on flat arrays; meshes come in by
/// face_graph.h, plain spans of points (a CAD kernel's control points) as they are.
///
/// BindMode::continuous. A point's deformation is (1 - b) times that of its nearest projection and b times
/// the mean over the places of the axes around it, weighted by their closeness alone, which nothing makes
/// jump. b is 0 but near the cut locus of the axes, where the nearest projection jumps or splits, and 1
/// there: it follows the distance along which the nearest stays the nearest. Points with b = 0 are bound as
/// by BindMode::nearest, to the last bit. A projection counts only where a way over the mesh joins it to a
/// point it is the nearest of.
///
/// Memory: 2 (degree + 1) + 4 numbers a place. Making it costs a projection a point, an update two basis sums
/// and a frame for each place in use.
class Binding {
 public:
  /// Each point to its nearest projection.
  /// \param rest     the curve-pair the points are bound to, in its rest shape
  /// \param points   finite, else InvalidInput naming the point ("points[3]")
  /// \param threads  1 to 256; the same bits for any number
  Binding(const CurvePair& rest, Points points, int threads = 1);

  /// The points of a mesh, whose faces say which points are neighbours, to one or several curve-pairs (neck,
  /// tail, legs): which of them is nearest changes like which place of one.
  /// \param rest  at least one
  Binding(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& options);

  std::size_t size() const { return size_; }
  std::size_t pair_count() const { return knots_.size(); }
  /// Of each point's nearest projection.
  std::span<const AxialPoint> records() const { return {records_.data(), size_}; }
  /// The curve-pair that records()[point] is about.
  std::uint32_t pair_of(std::size_t point) const { return pair_.empty() ? 0 : pair_[point]; }
  /// All places a point is bound to, the nearest projection first. Weights sum to 1.
  std::vector<Share> shares(std::size_t point) const;
  const BindReport& report() const { return report_; }

  /// Every point on the posed curve-pairs: the weighted sum of c(t) + u l_x + v l_y + w l_z over its places,
  /// with exact frames.
  /// \param posed  on the same knots as the rest; else InvalidInput
  /// \param out    size() entries
  void update(std::span<const CurvePair> posed, MutablePoints out, int threads = 1) const;
  void update(const CurvePair& posed, MutablePoints out, int threads = 1) const;

  /// One point alone: the same bits as update gives it.
  Vec3 at(std::span<const CurvePair> posed, std::size_t point) const;
  Vec3 at(const CurvePair& posed, std::size_t point) const;

 private:
  struct Posed;
  Vec3 evaluate(const Posed& posed, std::size_t entry) const;
  Vec3 blend(std::span<const Posed> posed, std::size_t point) const;
  std::vector<Posed> pose(std::span<const CurvePair> posed) const;
  void reserve(std::size_t entries);
  void set(std::size_t entry, const CurvePair& pair, double t, const Vec3& point);
  void project(const CurvePair& rest, Points points, int threads);
  void share(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& options);
  void inspect(std::span<const CurvePair> rest, Points points, int threads);

  std::vector<KnotVector> knots_;   ///< of each curve-pair
  std::size_t size_ = 0, row_ = 0;  ///< points; numbers per entry in weights_

  // Entries: the nearest projection of every point, then the other places in use, point after point.
  std::vector<AxialPoint> records_;
  std::vector<std::uint32_t> pair_;  ///< empty when there is one curve-pair
  std::vector<std::int32_t> first_;  ///< first control point of each row
  std::vector<double> weights_;      ///< N_first.. and N'_first.., degree + 1 of each

  // Points with several places: their others are the entries [begin, end).
  struct Blend {
    std::uint32_t begin, end;
  };
  std::vector<std::uint32_t> blended_;  ///< ascending
  std::vector<Blend> blends_;
  std::vector<double> shares_;  ///< of the entries after size()

  std::vector<double> lambda_, gap_;
  BindReport report_;
};

}  // namespace tendril::bind
