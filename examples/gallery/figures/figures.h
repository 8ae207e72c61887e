#pragma once

#include <tendril/dynamics/system.h>

#include <numbers>

#include "page/figure.h"

namespace tendril::gallery {

inline constexpr double kPi = std::numbers::pi;

/// Where a node of a rod is.
inline Vec3 place(const System& system, const State& state, std::size_t rod, std::size_t node) {
  return state.y.segment<3>(3 * static_cast<Eigen::Index>(system.rods()[rod].first + node));
}

Figure four_frames_of_an_axis();         ///< 2.1, 2.3
Figure springs_that_lose_their_shape();  ///< 3.8, 3.3
Figure twist_of_a_bar();                 ///< 3.10
Figure masses_and_springs_counted();     ///< 3.11
Figure trumpet_of_four_children();       ///< 3.20, 3.19
Figure curve_through_the_masses();       ///< 3.12
Figure cloth_of_49_vertices();           ///< 4.1
Figure stingray_swims();                 ///< 4.3
Figure ribbon_dance();                   ///< 4.7
Figure plant_in_wind();                  ///< 4.5, 4.6, 3.19, 3.21

}  // namespace tendril::gallery
