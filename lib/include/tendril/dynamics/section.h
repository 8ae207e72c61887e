#pragma once

#include <tendril/base/export.h>

namespace tendril {

/// A cross-section, by its integrals about the centroid. Axis 1 lies along the node frame's l (x), axis 2
/// along m (y).
struct Section {
  double area;      ///< [length^2]
  double bending1;  ///< I_1 = integral of x^2: bending that turns the edge towards l [length^4]
  double bending2;  ///< I_2 = integral of y^2: towards m
  double torsion;   ///< J of Saint-Venant, not the polar moment unless circular [length^4]
  double polar;     ///< I_p = I_1 + I_2, for the spin inertia [length^4]
  double width;     ///< mean projected width, for drag [length]
};

/// Solid circle: I = pi r^4 / 4, J = pi r^4 / 2. All sizes positive and finite, else InvalidInput.
TENDRIL_CORE_API Section circular_section(double radius);

/// Solid ellipse with semi-axes a along l and b along m: J = pi a^3 b^3 / (a^2 + b^2).
TENDRIL_CORE_API Section elliptic_section(double a, double b);

/// Solid rectangle, full sizes a along l and b along m; J by Saint-Venant's series, to 1e-12 relative.
TENDRIL_CORE_API Section rectangular_section(double a, double b);

}  // namespace tendril
