#pragma once

#include "page/figure.h"

namespace tendril::gallery {

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
