#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/bind_options.h>
#include <tendril/bind/columns.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/control_forces.h>
#include <tendril/curve/curve_pair.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tendril::bind {

struct BindingLayout;  ///< the flat arrays, private to the module

/// Points bound to curve-pairs: each to its nearest point on the primary curves, as an AxialPoint
/// ([Chan 2008] section 2.2), or to several points of them with weights. Every AxialPoint of a point
/// reproduces its rest position, so any weights that sum to 1 do. Immutable once made, works on flat arrays;
/// meshes are converted by face_graph.h, plain spans of points (a CAD kernel's control points) used as given.
///
/// BindMode::continuous. A point's deformation is (1 - b) times that of its nearest projection and b times
/// the mean over the part of the axes around it, weighted by distance alone, so that nothing makes the mean
/// jump. b is 1 on the cut locus of the axes, where the nearest projection jumps or splits, and 0 beyond the
/// band about it. It follows the cut distance, along which the nearest point stays the nearest, and falls
/// along no edge of the mesh faster than over the band. Points with b = 0 are bound as by BindMode::nearest,
/// to the last bit. A projection counts only where a path on the mesh joins it, continuously, to a point
/// whose nearest it is.
///
/// An update goes span by span through records in binding order: points sorted by curve-pair and span, those
/// off the normal plane of their projection last, otherwise as they were given. The same bits for any number
/// of threads, on any vector unit, and for a point alone. Blended points follow fixed places of the axes,
/// whose rigid maps a pose finds once. Memory: 80 bytes a point, 12 a share.
class TENDRIL_BIND_API Binding {
 public:
  /// Each point to its nearest projection.
  /// \param rest     the curve-pair the points are bound to, in its rest shape
  /// \param points   finite, else InvalidInput naming the point ("points[3]")
  /// \param threads  1 to 256; the same bits for any number
  Binding(const CurvePair& rest, Points points, int threads = 1);

  /// The points of a mesh, whose faces say which points are neighbours, to one or several curve-pairs (neck,
  /// tail, legs), which are treated as parts of one axis.
  /// \param rest     at least one, in their rest shapes; else InvalidInput
  /// \param mesh     valid, else InvalidInput (require_valid)
  /// \param options  out of range: InvalidInput
  Binding(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& options);

  std::size_t size() const;        ///< number of points
  std::size_t pair_count() const;  ///< number of curve-pairs
  /// The nearest projection of each point.
  std::span<const AxialPoint> records() const;
  /// The curve-pair that records()[point] is about.
  std::uint32_t pair_of(std::size_t point) const;
  /// What a point is bound to, the nearest projection first. Weights sum to 1.
  std::vector<Share> shares(std::size_t point) const;
  const BindReport& report() const { return report_; }  ///< what was found while binding
  /// The points in binding order.
  std::span<const std::uint32_t> order() const;

  /// Every point on the posed curve-pairs: the weighted sum of c(t) + u l_x + v l_y + w l_z over its shares,
  /// with exact frames.
  /// \param posed    as many as pair_count(), on the same knots as the rest; else InvalidInput
  /// \param out      size() entries; else InvalidInput
  /// \param threads  1 to 256; else InvalidInput
  void update(std::span<const CurvePair> posed, MutablePoints out, int threads = 1) const;
  /// The same for one curve-pair.
  void update(const CurvePair& posed, MutablePoints out, int threads = 1) const;
  /// The same in binding order, which is the fastest: out.x[i] is of the point order()[i].
  void update(std::span<const CurvePair> posed, const Columns<double>& out, int threads = 1) const;

  /// One point alone, point < size(): the same bits as update gives it.
  Vec3 at(std::span<const CurvePair> posed, std::size_t point) const;
  /// The same for one curve-pair.
  Vec3 at(const CurvePair& posed, std::size_t point) const;
  /// Some points, in the order given, at less cost a point.
  void at(std::span<const CurvePair> posed, std::span<const std::uint32_t> points, MutablePoints out) const;

  /// How fast some points move where control points of `posed` move as those of `rates`, on the same knots,
  /// say, and its turn stays. A point without a frame (see pull_back) moves as the curve's point.
  /// InvalidInput as for update.
  void velocities(std::span<const CurvePair> posed, std::span<const CurvePair> rates,
                  std::span<const std::uint32_t> points, MutablePoints out) const;

  /// The transpose of update: forces on the points as forces on the control points that do the same virtual
  /// work, turns (CurvePair::set_turn) held, with the same resultant force and torque. A point without a
  /// frame (closer than 1e-8 to degenerate) is taken to follow the curve's point alone. Some 3 updates'
  /// time; same bits for any number of threads.
  /// \param posed    as for update
  /// \param forces   size() finite vectors; else InvalidInput
  /// \param threads  1 to 256; else InvalidInput
  /// \return  one entry per curve-pair
  std::vector<ControlForces> pull_back(std::span<const CurvePair> posed, Points forces,
                                       int threads = 1) const;
  /// Of forces on some of the points alone, one for each of `points`.
  std::vector<ControlForces> pull_back(std::span<const CurvePair> posed,
                                       std::span<const std::uint32_t> points, Points forces) const;

 private:
  friend class Bindingf;
  friend class BindingPoints;
  friend class SurfaceBinder;
  Binding() = default;
  std::shared_ptr<const BindingLayout> layout_;
  BindReport report_;
};

}  // namespace tendril::bind
