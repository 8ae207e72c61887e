#include "color_list.h"

namespace tendril::bind {

void ColorList::put(std::span<const double> rgba) {
  if (!any_) entries_.assign(before_first_, {kNone, kNone, kNone, kNone});
  any_ = true;
  Entry entry{0, 0, 0, kOpaque};
  std::transform(rgba.begin(), rgba.end(), entry.begin(),
                 [](double v) { return static_cast<float>(std::max(v, 0.0)); });
  entries_.push_back(entry);
}

Color ColorList::finished(const Entry& entry) const {
  if (entry[0] == kNone) return {170, 170, 170, 255};  // Geomview's default
  const auto to_color = [](float value, bool fraction) {
    return to_byte(std::min(255.0, (fraction ? 255 : 1) * static_cast<double>(value)));
  };
  Color color{0, 0, 0, 255};
  for (std::size_t k = 0; k < 3; ++k) color[k] = to_color(entry[k], color_.is_fraction());
  const bool fraction = !alpha_.above_one && (alpha_.written_as_fraction || color_.is_fraction());
  if (entry[3] != kOpaque) color[3] = to_color(entry[3], fraction);
  return color;
}

std::vector<Color> ColorList::finish() const {
  std::vector<Color> colors(entries_.size());
  for (std::size_t i = 0; i < colors.size(); ++i) colors[i] = finished(entries_[i]);
  return colors;
}

}  // namespace tendril::bind
