#pragma once

#include "accuracy/case.h"

namespace tendril::accuracy {

// Cantilevers: cantilever.cpp.
Case tip_load();
Case own_weight();
Case small_deflection();
Case end_moment();

// What buckles: buckling.cpp, coil.cpp.
Case pinned_post_buckling();
Case self_buckling();
Case michell_ring();
Case helical_buckling();

// Frequencies and waves: vibration.cpp, chains.cpp.
Case bending_frequencies();
Case axial_and_torsional_frequencies();
Case torsional_pendulum();
Case hanging_chain();
Case catenary();
Case wave_speed();

// Twist, sections and rest shapes: strips.cpp.
Case twisted_strip();
Case pretwisted_strip();
Case curved_leaf();
Case anisotropic_section();

// Trees: tree.cpp.
Case bent_tee();
Case swinging_tee();

// Flight and integrators: flight.cpp.
Case free_flight();
Case integrator_orders();
Case energy_orders();

}  // namespace tendril::accuracy
