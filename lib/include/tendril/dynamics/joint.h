#pragma once

#include <cstddef>

namespace tendril {

/// Joins a child rod to a node of a parent rod ([Chan 2008] section 3.6). The child's first node is that
/// node: same position, masses merged; its frame is fixed to the parent's frame, F_0 = F_j R_0 with R_0 the
/// rest rotation between the two. The child's springs at its first node (bend_l[0], bend_m[0], bend_t[0], and
/// twist[0] to the next) are the joint's, in series with the half edges at the parent's node, which give way
/// until all moments there balance: pieces joined end to end bend as one rod. Set them for another stiffness.
///
/// The reaction comes from the same energy: with g_t and g_s its derivatives by the child's root tangent t_0
/// and spin, and T = t_0 x g_t + t_0 g_s, the parent's node receives T x t_j and T.t_j, and the force on the
/// root. So linear and angular momentum are kept across joints. Of the root's spin inertia the
/// parent's node takes what turns about its tangent.
struct Joint {
  std::size_t parent = 0;  ///< rod
  std::size_t node = 0;  ///< of the parent; the child's first rest point must be there, to 1e-9 of its length
  std::size_t child = 0;  ///< rod; at most one joint a child, no cycles
  bool reaction = true;   ///< false: the child follows and the parent does not feel it (one-way hierarchy)
};

}  // namespace tendril
