#include "figures.h"

namespace tendril::gallery {

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"Twist", "3.10", twist_of_a_bar},
      {"Cloth", "4.1", cloth_of_49_vertices},
  };
  return all;
}

}  // namespace tendril::gallery
