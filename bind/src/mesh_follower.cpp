#include <tendril/base/error.h>
#include <tendril/bind/mesh_follower.h>

#include <string>

namespace tendril::bind {

MeshFollower::MeshFollower(const Binding& binding, std::size_t pair, MutablePoints out, int threads)
    : binding_(binding), pair_(pair), out_(out), threads_(threads) {
  if (out.size() != binding.size())
    throw InvalidInput("out", std::to_string(out.size()) + " points", std::to_string(binding.size()));
}

void MeshFollower::follow(double time, std::span<const CurvePair> pairs) {
  const std::size_t count = binding_.pair_count();
  if (pair_ + count > pairs.size())
    throw InvalidInput("curve-pair", std::to_string(pair_ + count - 1),
                       "less than " + std::to_string(pairs.size()));
  binding_.update(pairs.subspan(pair_, count), out_, threads_);
  time_ = time;
  ++updates_;
}

}  // namespace tendril::bind
