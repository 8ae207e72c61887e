#pragma once

#include <tendril/axis/axis_tree.h>

#include <functional>

#include "skeleton.h"

/// A skeleton as branches between its junctions and ends, and what is done to them before curves are fitted.
namespace tendril::axis {

using Line = std::vector<Vec3>;

double length_of(const Line& line);

struct Branch {
  std::uint32_t from, to;  ///< vertices
  Line line;               ///< from vertex to vertex, both included
};

struct BranchGraph {
  std::vector<Vec3> vertices;
  std::vector<Branch> branches;

  std::vector<int> degrees() const;  ///< of the vertices; a branch from a vertex to itself counts twice
  std::size_t loops() const;         ///< independent ones, of the one component
};

/// Nodes with two neighbours lie on branches, all others are vertices. A skeleton that is a mere loop gets
/// its first node for a vertex.
BranchGraph branches_of(const Skeleton& skeleton);

/// Distance of a point within the surface to it.
using Clearance = std::function<double(const Vec3&)>;

/// Prunes spurious end branches, the shortest first, until all that are left reach as far as
/// AxisOptions::prune asks. A branch is an end branch when one of its ends is free and the other a junction;
/// where only two branches remain they become one.
std::vector<Twig> prune(BranchGraph& graph, double least_reach, const Clearance& clearance);

/// Junctions within each other's clearance become one: a branch between them no longer than half the larger
/// of the two clearances goes, and those beyond it start where it started.
void merge_junctions(BranchGraph& graph, const Clearance& clearance);

/// Takes off free ends what runs into a corner, or on to the surface, from the middle of a blunt end.
void trim_ends(BranchGraph& graph, const Clearance& clearance);

/// Cuts each loop where the two shortest paths round it from the vertex of the largest clearance meet.
std::vector<Vec3> cut_loops(BranchGraph& graph, const Clearance& clearance);

}  // namespace tendril::axis
