#include "accuracy/contact/cases.h"

namespace tendril::contact {

const std::vector<accuracy::Entry>& contact_entries() {
  static const std::vector<accuracy::Entry> all{
      {"Capstan", capstan},
      {"StiffRodOverADrum", stiff_rod_over_a_drum},
      {"BentBack", bent_back},
      {"PressedRing", pressed_ring},
      {"ThreePointBending", three_point_bending},
      {"HeavyRodOnAFloor", heavy_rod_on_a_floor},
      {"HelixInATube", helix_in_a_tube},
      {"TwoPly", two_ply},
      {"LandingMass", landing_mass},
      {"EndOnImpact", end_on_impact},
      {"MassAndBarrier", mass_and_barrier},
      {"StickAndSlip", stick_and_slip},
  };
  return all;
}

const std::vector<accuracy::Entry>& long_contact_entries() {
  static const std::vector<accuracy::Entry> all{{"EndOnImpactFinely", end_on_impact_finely},
                                                {"OverhandKnot", overhand_knot}};
  return all;
}

}  // namespace tendril::contact
