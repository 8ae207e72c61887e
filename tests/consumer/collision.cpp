#include <tendril/collision/answer.h>
#include <tendril/collision/box_tree.h>

#include <iostream>

using namespace tendril;

int main() {
  std::vector<collision::Box> boxes;
  for (int i = 0; i < 5; ++i) boxes.push_back({Vec3(i, 0, 0), Vec3(i + 0.5, 1, 1)});
  const collision::BoxTree tree(boxes);
  int found = -1, many = 0;
  const collision::Box query{Vec3(3.1, 0.2, 0.2), Vec3(3.2, 0.3, 0.3)};
  tree.descend([&](const collision::Box& box) { return box.meets(query); },
               [&](std::size_t item) { found = static_cast<int>(item), ++many; });
  if (found != 3 || many != 1) return 1;
  if (collision::kHit == collision::undecidable(collision::Reason::open)) return 2;
  std::cout << "collision works\n";
}
