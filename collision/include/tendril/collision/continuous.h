#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>
#include <tendril/collision/answer.h>

#include <array>

/// Continuous tests: do two features of moving meshes meet between two steps, and when first?
///
/// Each vertex moves on a polynomial path, given by its time-control points (Bernstein form on [0, 1]): two
/// for a straight path, four for a cubic one, as those of path_of_record.h. Truth is closed: to touch is to
/// meet, at t = 0, at t = 1, at an edge and at a corner, and so do features without area or length.
namespace tendril::collision {

/// Which features the four vertices of a query are, in this order.
enum class Features {
  vertex_face,  ///< the vertex, then the corners of the face
  edge_edge,    ///< the ends of one edge, then those of the other
};

/// The paths of the four vertices: path[vertex][time-control point].
template <int Degree>
using Paths = std::array<std::array<Vec3, Degree + 1>, 4>;

/// Whether the features meet.
enum class Meeting {
  free,      ///< at no time
  hit,       ///< at some time
  undecided  ///< not known; why, the reason says
};

/// The answer of a continuous test. Its times are doubles, exact as they stand.
struct FirstMeeting {
  Meeting meeting = Meeting::undecided;  ///< whether the features meet
  Reason reason = Reason::none;          ///< of `undecided`: not_finite or rounding
  /// There is no meeting before; of a hit, the first one is in [from, to].
  double from = 0.0;
  /// Of a hit: at most 2^-40 after `from`, but for the test in doubles where they cannot narrow it to that;
  /// the determinant of the four vertices then has one root between the two.
  double to = 1.0;
};

/// The test in doubles. `free` and `hit` are proven for these very doubles, of any size, in any rounding
/// mode; what rounding leaves open is `undecided`, never guessed.
///
/// Time alone is subdivided, the earlier half first. With d_i the paths of the other three vertices relative
/// to the first, an interval is free when along one direction, that of the closest points of the features in
/// its midst, the control points of the differences stay apart by more than the rounding error; a meeting
/// in it is proven when det(d_1, d_2, d_3), a polynomial in Bernstein form, has one root there while the
/// weights with which the features would meet, 2 x 2 minors of the d_i, keep their signs (intermediate value
/// theorem). Where that root is too flat for doubles to narrow, sums of two doubles do. About 0.2 us for a
/// query far from meeting. Queries of the public format: [Wang et al. 2021].
/// \param features  what the vertices are
/// \param paths     of degree 1 or 3; not finite: `undecided` for that reason
template <int Degree>
TENDRIL_COLLISION_API FirstMeeting first_meeting(Features features, const Paths<Degree>& paths);

}  // namespace tendril::collision
