#pragma once

#include "page/figure.h"

namespace tendril::gallery {

Figure twist_of_a_bar();        ///< 3.10
Figure cloth_of_49_vertices();  ///< 4.1

}  // namespace tendril::gallery
