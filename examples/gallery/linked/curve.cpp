// The least that deforms points: a curve-pair, posed by hand, and a point in its coordinates.
#include <tendril/curve/axial.h>

#include <cstdio>

using namespace tendril;

int main() {
  const CurvePair pair({3, {0, 0, 0, 0, 1, 1, 1, 1}}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 1}, {3, 0, 2}},
                       {{0, 1, 0}, {1, 1, 0}, {2, 1, 1}, {3, 1, 2}});
  const Vec3 p = from_axial(pair, {0.5, 0.1, 0.2, 0});
  std::printf("%g %g %g\n", p.x(), p.y(), p.z());
}
