#pragma once

#include <tendril/curve/axial.h>
#include <tendril/curve/closest_point.h>

#include <cstdint>
#include <span>
#include <vector>

namespace tendril::bind {

/// What binding found out about its points.
struct BindReport {
  double rest_error =
      0.0;  ///< largest distance between a point and its update on the unmoved curve-pair [length]
  double largest_gap =
      0.0;  ///< largest proven gap of a projection: how much longer than the true minimum [length]
  std::size_t beyond_ends = 0;            ///< points nearest to one of the two ends
  std::vector<std::uint32_t> degenerate;  ///< points whose frame has a status other than ok
  std::vector<std::uint32_t>
      past_focus;  ///< points with lambda <= 0: the axis bends round them, the map folds there
};

/// Points bound to a curve-pair: each to its nearest point on the primary curve, as an axial record
/// (thesis 2.2). Immutable once made, works on flat arrays; meshes come in by face_graph.h, plain spans of
/// points (a CAD kernel's control points) as they are.
///
/// Memory: 2 (degree + 1) + 4 numbers a point. Making it costs a projection a point, an update two basis sums
/// and a frame.
class Binding {
 public:
  /// \param rest     the curve-pair the points are bound to, in its rest shape
  /// \param points   finite, else InvalidInput naming the point ("points[3]")
  /// \param threads  1 to 256; the same bits for any number
  Binding(const CurvePair& rest, Points points, int threads = 1);

  std::size_t size() const { return records_.size(); }
  std::span<const AxialPoint> records() const { return records_; }
  const BindReport& report() const { return report_; }

  /// Every point on the posed curve-pair: out[i] = c(t_i) + u_i l_x + v_i l_y + w_i l_z, with exact frames.
  /// \param posed  on the same knots as the rest; else InvalidInput
  /// \param out    size() entries
  void update(const CurvePair& posed, MutablePoints out, int threads = 1) const;

  /// One point alone: the same bits as update gives it.
  Vec3 at(const CurvePair& posed, std::size_t point) const;

 private:
  struct Posed;
  Vec3 evaluate(const Posed& posed, std::size_t point) const;
  Posed pose(const CurvePair& posed) const;
  void project(const CurvePair& rest, Points points, int threads);
  void inspect(const CurvePair& rest, Points points, int threads);

  KnotVector knots_;
  std::vector<AxialPoint> records_;
  std::vector<std::int32_t> first_;  ///< first control point of each row
  std::vector<double> weights_;      ///< per point N_first.. and N'_first.., degree + 1 of each
  std::vector<double> lambda_, gap_;
  BindReport report_;
};

}  // namespace tendril::bind
