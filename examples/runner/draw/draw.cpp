#include "draw/tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>

namespace tendril::runner {
namespace {

constexpr int kCell = 4;        // pixels between the places where light from the sky is measured
constexpr int kSkyRays = 48;    // at each of them
constexpr int kOwnRays = 24;    // where a pixel finds none of its surface about it
constexpr float kAlike = 0.9F;  // cosine between normals of one smooth surface
constexpr float kNear = 0.02F;  // of the size: how far off a tangent plane it may be

template <class F>
void for_each_row(int rows, int threads, F work_on) {
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int y = next++; y < rows; y = next++) work_on(y);
  };
  std::vector<std::jthread> helpers;
  for (int k = 1; k < threads; ++k) helpers.emplace_back(work);
  work();
}

bool is_one_surface(const Seen& a, const Seen& b) {
  return a.kind == b.kind && a.normal.dot(b.normal) > kAlike && std::abs((a.at - b.at).dot(a.normal)) < kNear;
}

/// A picture in three passes. First one ray through each pixel's middle, and one on to the sun. Then the
/// light of the sky, which changes slowly, at the corners of cells of pixels, by many rays. Then the pixels:
/// where all about one look alike, what is known does; the others, at edges, in half shadow and under
/// strands, get all their samples. No pass reads what its own threads write.
class Canvas {
 public:
  Canvas(const Tracer& tracer, const scene::ViewOptions& view, int threads)
      : tracer_(tracer),
        view_(view),
        columns_((view.width + kCell - 1) / kCell + 1),
        rows_((view.height + kCell - 1) / kCell + 1),
        seen_(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height)),
        sunlit_(seen_.size()),
        sky_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for_each_row(view.height, threads, [&](int y) {
      for (int x = 0; x < view_.width; x += static_cast<int>(kBundle)) look_at_middles(x, y);
    });
    std::vector<float> measured(sky_.size());
    for_each_row(rows_, threads, [&](int j) {
      for (int i = 0; i < columns_; ++i)
        measured[cell(i, j)] = tracer_.skylight(corner(i, j), Samples(across(i), down(j)), kSkyRays);
    });
    for_each_row(rows_, threads, [&](int j) {
      for (int i = 0; i < columns_; ++i) sky_[cell(i, j)] = smoothed(measured, i, j);
    });
  }

  /// Linear light.
  Vec3f color(int x, int y) const {
    const Seen& middle = seen_[pixel(x, y)];
    if (is_plain(x, y)) return tracer_.shade(middle, sunlit_[pixel(x, y)], sky(middle, x, y));
    const Samples samples(x, y);
    Vec3f sum = Vec3f::Zero();
    for (int s = 0; s < view_.samples; s += static_cast<int>(kBundle))
      sum += light_of(x, y, samples, s, std::min(kBundle, static_cast<std::size_t>(view_.samples - s)));
    return sum / static_cast<float>(view_.samples);
  }

 private:
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(x);
  }
  std::size_t cell(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  }
  const Seen& corner(int i, int j) const { return seen_[pixel(across(i), down(j))]; }

  /// Over the corners about one that are on its surface: takes the grain out.
  float smoothed(const std::vector<float>& measured, int i, int j) const {
    float sum = 0.0F, weights = 0.0F;
    for (int b = std::max(0, j - 1); b <= std::min(rows_ - 1, j + 1); ++b)
      for (int a = std::max(0, i - 1); a <= std::min(columns_ - 1, i + 1); ++a) {
        if (!is_one_surface(corner(i, j), corner(a, b))) continue;
        const float weight = (a == i ? 2.0F : 1.0F) * (b == j ? 2.0F : 1.0F);
        sum += weight * measured[cell(a, b)];
        weights += weight;
      }
    return weights > 0.0F ? sum / weights : measured[cell(i, j)];
  }

  /// The pixel of a cell's corner.
  int across(int i) const { return std::min(i * kCell, view_.width - 1); }
  int down(int j) const { return std::min(j * kCell, view_.height - 1); }

  Eigen::Vector2f place(int x, int y, const Eigen::Vector2f& part) const {
    return {2.0F * (static_cast<float>(x) + part.x()) / static_cast<float>(view_.width) - 1.0F,
            1.0F - 2.0F * (static_cast<float>(y) + part.y()) / static_cast<float>(view_.height)};
  }

  /// At a pixel and those to the right of it.
  void look_at_middles(int first, int y) {
    const std::size_t count = std::min(kBundle, static_cast<std::size_t>(view_.width - first));
    std::array<Eigen::Vector2f, kBundle> places, sun;
    for (std::size_t k = 0; k < count; ++k) {
      const int x = first + static_cast<int>(k);
      places[k] = place(x, y, {0.5F, 0.5F});
      sun[k] = Samples(x, y).pair(1, 0);
    }
    const std::span<Seen> seen(&seen_[pixel(first, y)], count);
    tracer_.look({places.data(), count}, seen);
    tracer_.sunlit(seen, {sun.data(), count}, {&sunlit_[pixel(first, y)], count});
  }

  /// The light of a pixel's samples from `first` on, added up.
  Vec3f light_of(int x, int y, const Samples& samples, int first, std::size_t count) const {
    std::array<Eigen::Vector2f, kBundle> places, sun;
    std::array<Seen, kBundle> seen;
    std::array<std::uint8_t, kBundle> lit;
    for (std::size_t k = 0; k < count; ++k) {
      places[k] = place(x, y, samples.pair(0, first + static_cast<int>(k)));
      sun[k] = samples.pair(1, first + static_cast<int>(k));
    }
    tracer_.look({places.data(), count}, {seen.data(), count});
    tracer_.sunlit({seen.data(), count}, {sun.data(), count}, {lit.data(), count});
    Vec3f sum = Vec3f::Zero();
    for (std::size_t k = 0; k < count; ++k)
      sum += tracer_.shade(seen[k], static_cast<float>(lit[k]), sky(seen[k], x, y));
    return sum;
  }

  /// Whether all within two pixels agree on the sun: in a half shadow few do.
  bool is_evenly_lit(int x, int y) const {
    for (int v = std::max(0, y - 2); v <= std::min(view_.height - 1, y + 2); ++v)
      for (int u = std::max(0, x - 2); u <= std::min(view_.width - 1, x + 2); ++u)
        if (sunlit_[pixel(u, v)] != sunlit_[pixel(x, y)]) return false;
    return true;
  }

  bool is_plain(int x, int y) const {
    const Seen& middle = seen_[pixel(x, y)];
    for (int v = std::max(0, y - 1); v <= std::min(view_.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(view_.width - 1, x + 1); ++u) {
        const Seen& other = seen_[pixel(u, v)];
        if (other.strand || other.kind != middle.kind) return false;
        if (middle.kind != Seen::Kind::surface) continue;
        if (!is_one_surface(middle, other) || (middle.color - other.color).cwiseAbs().maxCoeff() > 0.02F)
          return false;
      }
    return is_evenly_lit(x, y);
  }

  /// Between the corners about a pixel that are on its surface.
  float sky(const Seen& seen, int x, int y) const {
    if (seen.kind == Seen::Kind::wall) return 1.0F;
    const int i = x / kCell, j = y / kCell;
    const float fx = static_cast<float>(x % kCell) / kCell, fy = static_cast<float>(y % kCell) / kCell;
    float sum = 0.0F, weights = 0.0F;
    for (const int b : {0, 1})
      for (const int a : {0, 1}) {
        if (!is_one_surface(seen, corner(i + a, j + b))) continue;
        const float weight = (a == 0 ? 1.0F - fx : fx) * (b == 0 ? 1.0F - fy : fy) + 1e-3F;
        sum += weight * sky_[cell(i + a, j + b)];
        weights += weight;
      }
    return weights > 0.0F ? sum / weights : tracer_.skylight(seen, Samples(x, y), kOwnRays);
  }

  const Tracer& tracer_;
  scene::ViewOptions view_;
  int columns_, rows_;  ///< of the cells' corners
  std::vector<Seen> seen_;
  std::vector<std::uint8_t> sunlit_;
  std::vector<float> sky_;
};

/// From light to bytes: straight up to 0.7, then a shoulder that keeps highlights from clipping; the eye's
/// gamma of 2.2. A table over the root of the light, of which the curve is nearly a straight line.
class Encoder {
 public:
  Encoder() {
    for (std::size_t k = 0; k < table_.size(); ++k) {
      const float root = static_cast<float>(k) / kSteps, light = root * root, knee = 0.7F;
      const float soft =
          light <= knee ? light : knee + (1.0F - knee) * (1.0F - std::exp(-(light - knee) / (1.0F - knee)));
      table_[k] = 255.0F * std::pow(std::min(soft, 1.0F), 1.0F / 2.2F);
    }
  }

  /// \param dither  0 to 1, hides the steps of 8 bits in the pale background
  std::uint8_t operator()(float light, float dither) const {
    const float at = std::min(kSteps * std::sqrt(std::max(light, 0.0F)), kSteps * kMost - 1.0F);
    const auto k = static_cast<std::size_t>(at);
    const float encoded = table_[k] + (at - static_cast<float>(k)) * (table_[k + 1] - table_[k]);
    return static_cast<std::uint8_t>(std::min(255.0F, encoded + dither));
  }

 private:
  static constexpr float kSteps = 512.0F, kMost = 2.0F;  // beyond its square, all is white
  std::array<float, static_cast<std::size_t>(kSteps* kMost) + 1> table_;
};

}  // namespace

Picture draw(const Drawing& drawing, const Camera& camera, const scene::ViewOptions& view, int threads) {
  const Tracer tracer(drawing, camera);
  const Canvas canvas(tracer, view, threads);
  const Encoder encode;
  Picture picture(view.width, view.height);
  for_each_row(view.height, threads, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const Vec3f light = canvas.color(x, y);
      const float dither = Samples(x, y).pair(3, 0).x();
      for (int k = 0; k < 3; ++k) picture.pixel(x, y)[k] = encode(light[k], dither);
    }
  });
  return picture;
}

}  // namespace tendril::runner
