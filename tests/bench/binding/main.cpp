// Times of bindings, projections, readers and judges, and of their peers, from one run on one thread; the
// arguments are those of command_line.h.
#include "bench/binding/sections.h"

int main(int argc, char** argv) {
  using namespace tendril::bench;
  return run_bench(argc, argv, true, {},
                   {{"update", "update", update_section},
                    {"transpose", "transpose", transpose_section},
                    {"projection", "projection", projection_section},
                    {"reading", "reading", reading_section},
                    {"tree", "tree", tree_section},
                    {"judging", "judging", judging_section}});
}
