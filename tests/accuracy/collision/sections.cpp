#include "accuracy/collision/suite.h"

namespace tendril::suite {

std::vector<Section> sections() {
  return {{"triangles", "two triangles", triangles_section},
          {"segments", "a triangle and a segment", segments_section},
          {"distance", "the distance of two triangles", distance_section},
          {"inside", "points within closed meshes", inside_section},
          {"balls", "solid balls and meshes", balls_section},
          {"straight", "vertices, faces and edges that move straight", straight_section},
          {"cubic", "the same on cubics", cubic_section},
          {"bound", "meshes that follow curve-pairs", bound_section},
          {"posed", "the same handed over in every pose", posed_section},
          {"hostile", "numbers that wish no good", hostile_section}};
}

}  // namespace tendril::suite
