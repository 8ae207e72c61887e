#include "query/still_points.h"

namespace tendril::runner {
namespace {

struct Kept {
  std::size_t place;  ///< in its group
  Vec3 at;
};

class Groups : public PointGroups {
 public:
  Groups(std::unique_ptr<PointGroups> all, std::vector<std::vector<Kept>> kept, std::size_t pairs)
      : all_(std::move(all)), kept_(std::move(kept)), pairs_(pairs) {}

  void pose(std::span<const CurvePair> posed) override { all_->pose(posed.first(pairs_)); }
  void place(std::size_t group, MutablePoints out) const override {
    all_->place(group, out);
    for (const Kept& kept : kept_[group]) out[kept.place] = kept.at;
  }

 private:
  std::unique_ptr<PointGroups> all_;
  std::vector<std::vector<Kept>> kept_;  ///< of each group
  std::size_t pairs_;
};

}  // namespace

StillPoints::StillPoints(const bind::Binding& binding, std::span<const std::size_t> still, Points at)
    : binding_(binding), points_(binding) {
  for (const std::size_t i : still) still_.emplace(i, at[i]);
}

void StillPoints::shares(std::size_t point, std::vector<BoundShare>& out) const {
  points_.shares(point, out);
  if (still_.count(point) == 0) return;
  const auto its_own = static_cast<std::uint32_t>(binding_.pair_count()) + binding_.pair_of(point);
  out.assign(1, {its_own, 1.0, binding_.records()[point]});
}

std::unique_ptr<PointGroups> StillPoints::group(std::span<const std::uint32_t> begin,
                                                std::span<const std::uint32_t> points) const {
  std::vector<std::vector<Kept>> kept;
  for (std::size_t g = 0; g + 1 < begin.size(); ++g) {
    kept.emplace_back();
    for (std::uint32_t i = begin[g]; i < begin[g + 1]; ++i)
      if (const auto found = still_.find(points[i]); found != still_.end())
        kept.back().push_back({i - begin[g], found->second});
  }
  return std::make_unique<Groups>(points_.group(begin, points), std::move(kept), binding_.pair_count());
}

}  // namespace tendril::runner
