#pragma once

#include "accuracy/case.h"

/// Contact in the validation book: references with known digits.
namespace tendril::contact {

// One degree of freedom: law.cpp.
accuracy::Case mass_and_barrier();
accuracy::Case stick_and_slip();

// Rods on drums: drums.cpp.
accuracy::Case capstan();
accuracy::Case stiff_rod_over_a_drum();

// Beams, rings and bends: bent.cpp.
accuracy::Case bent_back();
accuracy::Case pressed_ring();
accuracy::Case three_point_bending();
accuracy::Case heavy_rod_on_a_floor();

// Helices: helices.cpp.
accuracy::Case helix_in_a_tube();
accuracy::Case two_ply();

// Impacts: struck.cpp.
accuracy::Case landing_mass();
accuracy::Case end_on_impact();
accuracy::Case end_on_impact_finely();  ///< 128 edges: some ten seconds

// knot.cpp.
accuracy::Case overhand_knot();  ///< minutes

/// The cases of the book.
const std::vector<accuracy::Entry>& contact_entries();
/// Those that take long, for the long tests.
const std::vector<accuracy::Entry>& long_contact_entries();

}  // namespace tendril::contact
