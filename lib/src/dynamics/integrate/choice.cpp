#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/rodas.h>

#include <algorithm>
#include <utility>

#include "controller.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

// A step of RODAS costs about as much as this many of Cash-Karp.
constexpr double kImplicitCost = 4.5;
constexpr double kImplicitCostWithTwist = 12.0;
// No change back and forth: explicit steps must be too dear, or cheap enough, by this factor.
constexpr double kMargin = 2.0;
constexpr long kExplicitInterval = 64;  // accepted steps between looks at the choice
constexpr long kImplicitInterval = 16;  // at first; doubled while far from a change
constexpr long kLongestInterval = 256;

}  // namespace

bool Controller::explicit_fits() const {
  const double needed = 6.0 * (until_ - state_.time) / report_.guard_step;
  return needed < static_cast<double>(options_.work_limit - evaluations());
}

void Controller::take(std::unique_ptr<EmbeddedStepper> stepper, std::string reason) {
  other_evaluations_ += embedded_->evaluations();
  embedded_ = std::move(stepper);
  report_.method = embedded_->name();
  report_.switches.push_back({state_.time, report_.method, std::move(reason)});
}

void Controller::choose() {
  if (since_guard_ < (embedded_->stiff() ? implicit_interval_ : kExplicitInterval)) return;
  measure_guard();
  const bool first = !std::exchange(started_, true);
  const double wish = first || embedded_->stiff() ? h_ : wished_;
  const double ratio = wish / report_.guard_step;
  const auto numbers = [&] {
    return sentence("accuracy asks for steps of ", wish, ", the guard of explicit steps allows ",
                    report_.guard_step);
  };
  const double cost = system_.twist_count() > 0 ? kImplicitCostWithTwist : kImplicitCost;
  if (!embedded_->stiff() && (ratio > kMargin * cost || !explicit_fits()))
    take(std::make_unique<Rodas>(system_), numbers());
  else if (embedded_->stiff() && ratio < cost / kMargin && explicit_fits())
    take(std::make_unique<CashKarp>(system_), numbers());
  else if (first)
    report_.switches.push_back({state_.time, report_.method, numbers()});
  const bool far = embedded_->stiff() && ratio > 4.0 * cost / kMargin;
  implicit_interval_ =
      far ? std::clamp(2 * implicit_interval_, kImplicitInterval, kLongestInterval) : kImplicitInterval;
}

}  // namespace tendril
