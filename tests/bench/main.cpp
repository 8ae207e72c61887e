// Times of the dynamics and of its peers, from one run on one thread; the arguments are those of
// command_line.h.
#include <cstdio>

#include "bench/sections.h"

int main(int argc, char** argv) {
  using namespace tendril::bench;
  OrderedJson out;
  for (const std::string& peer : {odeint_version(), sundials_version(), mujoco_version()}) {
    std::printf("peer: %s\n", peer.c_str());
    out["peers"].push_back(peer);
  }
  return run_bench(argc, argv, false, std::move(out),
                   {{"rhs", "right_hand_side", right_hand_side},
                    {"wind", "wind", trees_in_wind},
                    {"growth", "growth", growth},
                    {"plant", "plant", plant_in_real_time},
                    {"mujoco", "mujoco", mujoco_chain},
                    {"stiff", "stiff_rods", stiff_rods}});
}
