#include "figures.h"

namespace tendril::gallery {

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"Frames", "2.1", four_frames_of_an_axis},
      {"Equilibria", "3.8", springs_that_lose_their_shape},
      {"Twist", "3.10", twist_of_a_bar},
      {"Counts", "3.11", masses_and_springs_counted},
      {"Fitted", "3.12", curve_through_the_masses},
      {"Trumpet", "3.20", trumpet_of_four_children},
      {"Cloth", "4.1", cloth_of_49_vertices},
      {"Stingray", "4.3", stingray_swims},
      {"Plant", "4.5", plant_in_wind},
      {"Ribbon", "4.7", ribbon_dance},
  };
  return all;
}

}  // namespace tendril::gallery
