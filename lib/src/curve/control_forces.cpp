#include <tendril/base/error.h>
#include <tendril/curve/control_forces.h>

#include <string>

namespace tendril {

MassLoads loads_on_masses(const Interpolator& fit, const ControlForces& forces, Points arm) {
  MassLoads loads{fit.solve_transposed(forces.primary), fit.solve_transposed(forces.orientation)};
  if (arm.size() != loads.force.size())
    throw InvalidInput("arm", std::to_string(arm.size()) + " of them", std::to_string(loads.force.size()));
  for (std::size_t i = 0; i < arm.size(); ++i) {
    const Vec3 on_q = loads.torque[i];
    loads.force[i] += on_q;
    loads.torque[i] = arm[i].cross(on_q);
  }
  return loads;
}

}  // namespace tendril
