#include <tendril/exact/shape.h>

#include <iostream>

using namespace tendril;

int main() {
  const exact::Triangle floor{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const exact::Shape above = exact::ball(Vec3(0.25, 0.25, 0.5), 0.5);
  if (exact::relation(above, exact::triangle(floor)) != collision::kTouching) return 1;
  const exact::Segment pin{Vec3(0.1, 0.1, -1), Vec3(0.2, 0.2, 1)};
  if (exact::relation(exact::segment(pin), exact::triangle(floor)) != collision::kHit) return 2;
  std::cout << "exact works\n";
}
