#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>
#include <tendril/dynamics/section.h>

#include <vector>

namespace tendril {

/// One curve-pair as a rod of point masses: rest shape, inertia and springs, per node or per edge. Edge i
/// joins the nodes i and i + 1. Whatever the rest shape (curved, twisted), it carries no stress.
struct Rod {
  std::vector<Vec3> p;  ///< rest positions of the primary masses, n >= 2
  std::vector<Vec3> q;  ///< of the orientation masses; only their direction across the tangent matters

  std::vector<double> mass;     ///< per node
  std::vector<double> inertia;  ///< per node, for the spin about the tangent [mass length^2]

  std::vector<double> stretch;  ///< per edge, K_s: 1/2 K_s (|e| - L)^2 [force / length]
  /// Per node [torque / rad], for each adjacent edge e: 1/2 K (phi e.l / sin(phi) - rest)^2, phi from t to e.
  std::vector<double> bend_l;
  std::vector<double> bend_m;  ///< the same of phi e.m / sin(phi)
  std::vector<double> bend_t;  ///< the same of the angle between e and t, the third spring of [Chan 2008]
  std::vector<double> twist;   ///< per edge, K_w: 1/2 K_w (tau - rest)^2 [torque / rad]
  std::vector<double> width;   ///< per edge, for drag [length]

  double mass_damping = 0.0;  ///< alpha [1 / time]: force -alpha m v, torque -alpha I w
  /// beta of Kelvin-Voigt [time]: each spring but the third acts on strain + beta strain'.
  double viscosity = 0.0;
};

/// A homogeneous, linearly elastic material.
struct Material {
  double young;    ///< E [force / length^2], positive
  double shear;    ///< G, positive
  double density;  ///< rho [mass / length^3], positive
};

/// Rod of one material and section. With L an edge's rest length, L_v the mean of those at a node and H_v
/// half their sum, which differ at the ends: K_s = E A / L, K_l = 2 E I_1 / L_v, K_m = 2 E I_2 / L_v, K_w = G
/// J / L, mass rho A H_v, spin inertia rho I_p H_v; the third spring is 0. A clamped cantilever of it
/// converges to the elastica at second order in the edge length. Throws InvalidInput for numbers of points
/// that differ, edges of length 0, and a material that is not positive.
/// \param p         rest positions, at least 2
/// \param q         orientation masses, as many
/// \param material  of the whole rod
/// \param section   of the whole rod, its axes 1 and 2 along l and m
TENDRIL_CORE_API Rod make_rod(const std::vector<Vec3>& p, const std::vector<Vec3>& q,
                              const Material& material, const Section& section);

/// The constants of [Chan 2008], the same at every node and edge.
struct SpringConstants {
  double stretch;      ///< K^t of 3.11
  double bend_l;       ///< K_theta of 3.12
  double bend_m;       ///< K_lambda of 3.12
  double bend_t;       ///< K_beta of 3.12
  double twist;        ///< K_omega of 3.15
  double mass;         ///< of one p_i
  double inertia;      ///< of one q_i about the tangent: m_q r^2
  double width = 0.0;  ///< for drag [length]
};

/// Rod of these constants. Throws InvalidInput as above.
TENDRIL_CORE_API Rod make_rod(const std::vector<Vec3>& p, const std::vector<Vec3>& q,
                              const SpringConstants& springs);

/// Orientation masses for a chain: p_i + offset * (component of `side` across the tangent there).
/// InvalidInput where `side` lies along a tangent, naming the node, and where the offset of one node, carried
/// by the smallest rotation of the tangents, is more than 90 degrees off the next one's, naming both.
TENDRIL_CORE_API std::vector<Vec3> orientation_towards(const std::vector<Vec3>& p, const Vec3& side,
                                                       double offset);

}  // namespace tendril
