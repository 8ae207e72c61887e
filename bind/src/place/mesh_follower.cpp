#include <tendril/base/error.h>
#include <tendril/bind/mesh_follower.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace tendril::bind {
namespace {

std::vector<std::size_t> from(std::size_t first, std::size_t count) {
  std::vector<std::size_t> out(count);
  std::iota(out.begin(), out.end(), first);
  return out;
}

bool consecutive(const std::vector<std::size_t>& list) {
  return std::adjacent_find(list.begin(), list.end(), [](auto a, auto b) { return b != a + 1; }) ==
         list.end();
}

}  // namespace

MeshFollower::MeshFollower(const Binding& binding, std::size_t pair, MutablePoints out, int threads)
    : MeshFollower(binding, from(pair, binding.pair_count()), out, threads) {}

MeshFollower::MeshFollower(const Binding& binding, std::vector<std::size_t> pairs, MutablePoints out,
                           int threads)
    : binding_(binding), pairs_(std::move(pairs)), out_(out), threads_(threads) {
  if (out.size() != binding.size())
    throw InvalidInput("out", std::to_string(out.size()) + " points", std::to_string(binding.size()));
  if (pairs_.size() != binding.pair_count())
    throw InvalidInput("pairs", std::to_string(pairs_.size()), std::to_string(binding.pair_count()));
}

void MeshFollower::follow(double time, std::span<const CurvePair> pairs) {
  for (const std::size_t k : pairs_)
    if (k >= pairs.size())
      throw InvalidInput("curve-pair", std::to_string(k), "less than " + std::to_string(pairs.size()));
  if (consecutive(pairs_)) {
    binding_.update(pairs.subspan(pairs_.front(), pairs_.size()), out_, threads_);
  } else {
    std::vector<CurvePair> posed;
    for (const std::size_t k : pairs_) posed.push_back(pairs[k]);
    binding_.update(posed, out_, threads_);
  }
  time_ = time;
  ++updates_;
}

}  // namespace tendril::bind
