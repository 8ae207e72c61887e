#include <cmath>
#include <type_traits>

#include "describe.h"
#include "projection_lanes.h"

namespace tendril {
namespace {

using Found = CurveProjector::Data::Found;

/// Fills lanes with points whose parameter lies within a span, describes those, and leaves the others, at a
/// knot, to describe().
template <int P>
class Describer {
 public:
  Describer(const CurveProjector::Data& data, Points points, std::span<const Found> found)
      : data_(data), points_(points), found_(found), result_(points.size()) {}

  std::vector<Projection> run() {
    const auto knots = data_.curve.knots().knots();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto [t, least, known] = found_[i];
      const auto span = static_cast<std::size_t>(known >= 0 ? known : data_.curve.knots().span(t));
      if (t > knots[span] && t < knots[span + 1])
        push(i, span);
      else
        leave(i);
    }
    flush();
    return std::move(result_);
  }

 private:
  void leave(std::size_t i) { result_[i] = describe(data_, points_[i], found_[i]); }

  void push(std::size_t i, std::size_t span) {
    const auto knots = data_.curve.knots().knots();
    const Vec3& p = points_[i];
    lanes_.t[waiting_] = found_[i].t;
    lanes_.px[waiting_] = p.x();
    lanes_.py[waiting_] = p.y();
    lanes_.pz[waiting_] = p.z();
    for (std::size_t k = 0; k < 2 * P; ++k) lanes_.knot[k][waiting_] = knots[span + 1 + k - P];
    for (std::size_t k = 0; k <= P; ++k) {
      const Vec3& u = data_.curve.control_points()[span + k - P];
      lanes_.x[k][waiting_] = u.x();
      lanes_.y[k][waiting_] = u.y();
      lanes_.z[k][waiting_] = u.z();
    }
    length_[waiting_] = knots[span + 1] - knots[span];
    number_[waiting_] = i;
    if (++waiting_ == search::kLanes) flush();
  }

  void flush() {
    const std::size_t count = waiting_;
    waiting_ = 0;
    search::describe<P>(lanes_, (count + 7) / 8 * 8);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = number_[k];
      if (data_.at_rest(lanes_.speed[k], length_[k])) {
        leave(i);
        continue;
      }
      const double gap = std::max(0.0, lanes_.distance[k] - std::max(0.0, found_[i].least));
      result_[i] = {lanes_.t[k],        {lanes_.cx[k], lanes_.cy[k], lanes_.cz[k]},
                    lanes_.distance[k], ProjectionKind::interior,
                    lanes_.lambda[k],   gap};
    }
  }

  const CurveProjector::Data& data_;
  const Points points_;
  const std::span<const Found> found_;
  std::vector<Projection> result_;
  search::CurveLanes<P> lanes_{};
  std::array<double, search::kLanes> length_;
  std::array<std::size_t, search::kLanes> number_;
  std::size_t waiting_ = 0;
};

}  // namespace

template <int P>
std::vector<Projection> describe_all(const CurveProjector::Data& data, Points points,
                                     std::span<const Found> found) {
  return Describer<P>(data, points, found).run();
}

template std::vector<Projection> describe_all<1>(const CurveProjector::Data&, Points, std::span<const Found>);
template std::vector<Projection> describe_all<2>(const CurveProjector::Data&, Points, std::span<const Found>);
template std::vector<Projection> describe_all<3>(const CurveProjector::Data&, Points, std::span<const Found>);
template std::vector<Projection> describe_all<4>(const CurveProjector::Data&, Points, std::span<const Found>);
template std::vector<Projection> describe_all<5>(const CurveProjector::Data&, Points, std::span<const Found>);

}  // namespace tendril
