#include "accuracy/cases.h"

namespace tendril::accuracy {

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"TipLoad", tip_load},
      {"OwnWeight", own_weight},
      {"SmallDeflection", small_deflection},
      {"EndMoment", end_moment},
      {"PinnedPostBuckling", pinned_post_buckling},
      {"SelfBuckling", self_buckling},
      {"BendingFrequencies", bending_frequencies},
      {"AxialAndTorsionalFrequencies", axial_and_torsional_frequencies},
      {"TorsionalPendulum", torsional_pendulum},
      {"MichellRing", michell_ring},
      {"HelicalBuckling", helical_buckling},
      {"Catenary", catenary},
      {"HangingChain", hanging_chain},
      {"WaveSpeed", wave_speed},
      {"TwistedStrip", twisted_strip},
      {"PretwistedStrip", pretwisted_strip},
      {"CurvedLeaf", curved_leaf},
      {"AnisotropicSection", anisotropic_section},
      {"BentTee", bent_tee},
      {"SwingingTee", swinging_tee},
      {"FreeFlight", free_flight},
      {"IntegratorOrders", integrator_orders},
      {"EnergyOrders", energy_orders},
  };
  return all;
}

}  // namespace tendril::accuracy
