#pragma once

#include "page/figure.h"

namespace tendril::gallery {

Figure springs_that_lose_their_shape();  ///< 3.8, 3.3
Figure twist_of_a_bar();                 ///< 3.10
Figure masses_and_springs_counted();     ///< 3.11
Figure curve_through_the_masses();       ///< 3.12
Figure cloth_of_49_vertices();           ///< 4.1

}  // namespace tendril::gallery
