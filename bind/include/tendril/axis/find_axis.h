#pragma once

#include <tendril/axis/axis_options.h>
#include <tendril/axis/axis_tree.h>
#include <tendril/base/export.h>
#include <tendril/bind/polygon_mesh.h>

namespace tendril::axis {

/// A tree of curve-pairs along the middle of a closed surface (neck and tail, legs), found by CGAL's mean
/// curvature skeleton [Tagliasacchi et al. 2012] of Surface_mesh_skeletonization. That package and others
/// here are under the GPL: so is what links this component.
///
/// The skeleton's spurious end branches are pruned, each of its loops (handles of the surface) is cut open
/// where the two shortest paths round it from the widest junction meet, its branches are joined to paths from
/// the longest on, and free ends are carried on to where what is ahead is as far as what is beside. Each path
/// is drawn to the middle of the limb where a section across it is round, or where it is far nearer to one
/// side, and fitted by a cubic B-spline of as few control points as keep it within `tolerance` of that.
///
/// Deterministic: the same mesh gives the same bits, in every run. The mesh is scaled to a diagonal of 1, and
/// its points put on a grid of 2^-30 unless triangles are less than 64 of that high, so that a change of
/// units or of place, being rounding there, changes nothing but on the grid's borders. Seconds for 10^5
/// points, in one thread.
///
/// Throws InvalidInput("mesh", counts of all that is wrong, ...) unless the mesh, or the copy that the
/// options allow to be made, is one closed, manifold, consistently oriented surface without faces of no area.
/// \param mesh     polygons become fans of triangles; points in no face are left out
/// \param options  out of range: InvalidInput
TENDRIL_AXIS_API AxisTree find_axis(const bind::PolygonMesh& mesh, const AxisOptions& options = {});

}  // namespace tendril::axis
