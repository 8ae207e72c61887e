#include <tendril/base/error.h>
#include <tendril/base/types.h>

#include <iostream>
#include <limits>
#include <vector>

int main() {
  std::vector<tendril::Vec3> points(3, tendril::Vec3(1, 2, 3));
  const bool before = tendril::all_finite(points);
  points[1].z() = std::numeric_limits<double>::infinity();
  const tendril::InvalidInput error("points[1]", "infinite", "finite coordinates");
  if (!before || tendril::all_finite(points) || error.place() != "points[1]") return 1;
  std::cout << "core works\n";
}
