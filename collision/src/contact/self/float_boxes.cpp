#include "float_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tendril::contact {
namespace {

/// Not above x.
float below(double x) {
  const auto near = static_cast<float>(x);
  return near - std::abs(near) * std::numeric_limits<float>::epsilon() - std::numeric_limits<float>::min();
}

constexpr std::size_t kSides = 6;
constexpr std::uint32_t kBlock = 64;

/// A side of boxes, at the beginning and the end, and what a box may not be above that meets them there.
struct Side {
  const float* __restrict first;
  const float* __restrict last;
  float most_first, most_last;

  template <bool Moving>
  int meets(std::uint32_t i) const {
    const int here = static_cast<int>(first[i] <= most_first);
    return Moving ? here | static_cast<int>(last[i] <= most_last) : here;
  }
};
using Sides = std::array<Side, kSides>;

template <bool Moving>
void find(const Sides& sides, std::uint32_t from, std::uint32_t count,
          std::array<std::int32_t, kBlock>& meets) {
  const auto [x, y, z, u, v, w] = sides;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t i = from + k;
    meets[k] = x.meets<Moving>(i) & y.meets<Moving>(i) & z.meets<Moving>(i) & u.meets<Moving>(i) &
               v.meets<Moving>(i) & w.meets<Moving>(i);
  }
}

}  // namespace

void FloatBoxes::round(const collision::Box& box, std::size_t end, One& one) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    one[end * kSides + axis] = below(box.low[static_cast<Eigen::Index>(axis)]);
    one[end * kSides + 3 + axis] = below(-box.high[static_cast<Eigen::Index>(axis)]);
  }
}

void FloatBoxes::resize(std::size_t count, std::size_t ends) {
  ends_ = ends;
  for (std::size_t k = 0; k < ends_ * kSides; ++k) side_[k].resize(count);
}

void FloatBoxes::take(std::size_t index, std::size_t end, const collision::Box& box) {
  One one;
  round(box, 0, one);
  for (std::size_t k = 0; k < kSides; ++k) side_[end * kSides + k][index] = one[k];
}

void FloatBoxes::take(const FloatBoxes& from, const std::vector<std::uint32_t>& which) {
  ends_ = from.ends_;
  for (std::size_t k = 0; k < ends_ * kSides; ++k) {
    side_[k].resize(which.size());
    for (std::size_t i = 0; i < which.size(); ++i) side_[k][i] = from.side_[k][which[i]];
  }
}

/// Two boxes meet where no least coordinate of one is above the largest of the other.
void FloatBoxes::meeting(const One& box, std::uint32_t begin, std::uint32_t end,
                         std::vector<std::uint32_t>& which) const {
  Sides sides;
  const std::size_t last = (ends_ - 1) * kSides;
  for (std::size_t k = 0; k < kSides; ++k) {
    const std::size_t other = k < 3 ? k + 3 : k - 3;
    sides[k] = {side_[k].data(), side_[last + k].data(), -box[other], -box[last + other]};
  }
  which.resize(end - begin);
  std::size_t found = 0;
  for (std::uint32_t from = begin; from < end; from += kBlock) {
    const std::uint32_t count = std::min(kBlock, end - from);
    std::array<std::int32_t, kBlock> meets;
    if (ends_ == 1)
      find<false>(sides, from, count, meets);
    else
      find<true>(sides, from, count, meets);
    for (std::uint32_t k = 0; k < count; ++k) {
      which[found] = from + k;
      found += static_cast<std::size_t>(meets[k]);
    }
  }
  which.resize(found);
}

void FloatBoxes::meeting(const std::vector<collision::Box>& box, std::uint32_t begin, std::uint32_t end,
                         std::vector<std::uint32_t>& which) const {
  One one{};
  for (std::size_t k = 0; k < ends_; ++k) round(box[k], k, one);
  meeting(one, begin, end, which);
}

void FloatBoxes::meeting(const FloatBoxes& others, std::uint32_t index,
                         std::vector<std::uint32_t>& which) const {
  One one{};
  for (std::size_t k = 0; k < ends_ * kSides; ++k) one[k] = others.side_[k][index];
  meeting(one, 0, static_cast<std::uint32_t>(side_[0].size()), which);
}

}  // namespace tendril::contact
