#include <tendril/base/number.h>
#include <tendril/scene/trajectory.h>

namespace tendril::scene {
namespace {

void append(std::string& line, const Vec3& v) {
  for (const double x : v) line.append(1, ',').append(shortest(x));
}

}  // namespace

void Trajectory::add(const Snapshot& snapshot) {
  const std::string time = shortest(snapshot.time);
  for (std::size_t r = 0; r < snapshot.masses.size(); ++r) {
    for (std::size_t i = 0; i < snapshot.masses[r].size(); ++i) {
      csv_.append(time).append(1, ',').append(std::to_string(r)).append(1, ',').append(std::to_string(i));
      append(csv_, snapshot.masses[r][i]);
      append(csv_, snapshot.orientation[r][i]);
      csv_ += '\n';
    }
  }
}

}  // namespace tendril::scene
