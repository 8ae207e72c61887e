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

}  // namespace

FloatBoxes::One FloatBoxes::rounded(const collision::Box& box) {
  return {below(box.low.x()),   below(box.low.y()),   below(box.low.z()),
          below(-box.high.x()), below(-box.high.y()), below(-box.high.z())};
}

void FloatBoxes::take(const std::vector<collision::Box>& boxes) {
  for (std::vector<float>& side : side_) side.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const One one = rounded(boxes[i]);
    for (std::size_t k = 0; k < 6; ++k) side_[k][i] = one[k];
  }
}

void FloatBoxes::take(const FloatBoxes& from, const std::vector<std::uint32_t>& which) {
  for (std::size_t k = 0; k < 6; ++k) {
    side_[k].resize(which.size());
    for (std::size_t i = 0; i < which.size(); ++i) side_[k][i] = from.side_[k][which[i]];
  }
}

/// Two boxes meet where no least coordinate of one is above the largest of the other.
void FloatBoxes::meeting(const One& box, std::uint32_t begin, std::uint32_t end,
                         std::vector<std::uint32_t>& which) const {
  constexpr std::uint32_t kBlock = 64;
  which.resize(end - begin);
  std::size_t found = 0;
  const float a = -box[3], b = -box[4], c = -box[5], d = -box[0], e = -box[1], f = -box[2];
  const float *x = side_[0].data(), *y = side_[1].data(), *z = side_[2].data(), *u = side_[3].data(),
              *v = side_[4].data(), *w = side_[5].data();
  for (std::uint32_t from = begin; from < end; from += kBlock) {
    const std::uint32_t count = std::min(kBlock, end - from);
    std::array<std::int32_t, kBlock> meets;
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t i = from + k;
      meets[k] = static_cast<int>(x[i] <= a) & static_cast<int>(y[i] <= b) & static_cast<int>(z[i] <= c) &
                 static_cast<int>(u[i] <= d) & static_cast<int>(v[i] <= e) & static_cast<int>(w[i] <= f);
    }
    for (std::uint32_t k = 0; k < count; ++k) {
      which[found] = from + k;
      found += static_cast<std::size_t>(meets[k]);
    }
  }
  which.resize(found);
}

void FloatBoxes::meeting(const collision::Box& box, std::uint32_t begin, std::uint32_t end,
                         std::vector<std::uint32_t>& which) const {
  meeting(rounded(box), begin, end, which);
}

void FloatBoxes::meeting(const FloatBoxes& others, std::uint32_t index,
                         std::vector<std::uint32_t>& which) const {
  One one;
  for (std::size_t k = 0; k < 6; ++k) one[k] = others.side_[k][index];
  meeting(one, 0, static_cast<std::uint32_t>(side_[0].size()), which);
}

}  // namespace tendril::contact
