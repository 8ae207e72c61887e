#include <tendril/base/number.h>
#include <tendril/scene/support_table.h>

namespace tendril::scene {

void SupportTable::add(const SceneFile& file, const Snapshot& snapshot) {
  const std::string time = shortest(snapshot.time);
  for (std::size_t a = 0; a < snapshot.supports.size(); ++a) {
    const Anchor& anchor = file.scene.anchors[a];
    csv_ += time;
    for (const std::size_t number : {a, anchor.rod, anchor.node})
      csv_.append(1, ',').append(std::to_string(number));
    for (const Vec3& v : {snapshot.supports[a].force, snapshot.supports[a].torque})
      for (const double x : v) csv_.append(1, ',').append(shortest(x));
    csv_ += '\n';
  }
}

}  // namespace tendril::scene
