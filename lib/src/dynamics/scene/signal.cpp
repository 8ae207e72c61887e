#include <tendril/base/error.h>
#include <tendril/dynamics/signal.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace tendril {
namespace {

double finite(const char* what, double value) {
  if (!std::isfinite(value)) throw InvalidInput(what, "not finite", "a finite number");
  return value;
}

}  // namespace

Signal Signal::constant(double value) {
  Signal signal;
  signal.mean_ = finite("value", value);
  return signal;
}

Signal Signal::sinusoid(double amplitude, double frequency, double phase, double mean) {
  Signal signal;
  signal.kind_ = Kind::sinusoid;
  signal.amplitude_ = finite("amplitude", amplitude);
  signal.frequency_ = finite("frequency", frequency);
  signal.phase_ = finite("phase", phase);
  signal.mean_ = finite("mean", mean);
  return signal;
}

Signal Signal::table(std::vector<std::pair<double, double>> entries) {
  if (entries.empty()) throw InvalidInput("table", "empty", "at least one (time, value)");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string place = "table[" + std::to_string(i) + "]";
    if (!std::isfinite(entries[i].first) || !std::isfinite(entries[i].second))
      throw InvalidInput(place, "not finite", "a finite time and value");
    if (i > 0 && entries[i].first < entries[i - 1].first)
      throw InvalidInput(place, "time " + std::to_string(entries[i].first) + " before the entry above",
                         "ascending times");
  }
  Signal signal;
  signal.kind_ = Kind::table;
  signal.entries_ = std::move(entries);
  return signal;
}

double Signal::operator()(double t) const {
  if (kind_ == Kind::constant) return mean_;
  if (kind_ == Kind::sinusoid)
    return mean_ + amplitude_ * std::sin(2 * std::numbers::pi * frequency_ * t + phase_);
  const auto after = std::upper_bound(entries_.begin(), entries_.end(), t,
                                      [](double time, const auto& entry) { return time < entry.first; });
  if (after == entries_.begin()) return entries_.front().second;
  if (after == entries_.end()) return entries_.back().second;
  const auto before = after - 1;
  const double share = (t - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

double Signal::period() const {
  const bool waves = kind_ == Kind::sinusoid && amplitude_ != 0.0 && frequency_ != 0.0;
  return waves ? 1.0 / std::abs(frequency_) : std::numeric_limits<double>::infinity();
}

std::vector<double> Signal::breaks() const {
  std::vector<double> times;
  for (const auto& entry : entries_) times.push_back(entry.first);
  return times;
}

}  // namespace tendril
