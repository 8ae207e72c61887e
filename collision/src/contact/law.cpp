#include <tendril/base/error.h>
#include <tendril/contact/law.h>

#include <cmath>
#include <limits>

namespace tendril::contact {
namespace {

void require(bool good, const std::string& place, double value, const char* expected) {
  if (!good) throw InvalidInput(place, std::to_string(value), expected);
}

}  // namespace

void check(const Law& law, const std::string& place) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto positive = [](double x) { return x > 0.0 && x < kInfinite; };
  const auto at_least_0 = [](double x) { return x >= 0.0 && x < kInfinite; };
  require(positive(law.stiffness), place + ".stiffness", law.stiffness, "a positive number");
  require(positive(law.range), place + ".range", law.range, "a positive length");
  require(at_least_0(law.friction), place + ".friction", law.friction, "at least 0");
  require(at_least_0(law.stick_stiffness), place + ".stick_stiffness", law.stick_stiffness, "at least 0");
  require(at_least_0(law.stick_damping), place + ".stick_damping", law.stick_damping, "at least 0");
  require(at_least_0(law.damping), place + ".damping", law.damping, "at least 0");
}

Potential potential(const Law& law, double gap) {
  const double short_of = law.range - gap;
  if (!(short_of > 0.0)) return {0.0, 0.0, 0.0};
  if (law.kind == Law::Kind::penalty) return {0.5 * short_of * short_of, -short_of, 1.0};
  const double log = std::log(gap / law.range), ratio = short_of / gap;
  return {-short_of * short_of * log, short_of * (2.0 * log - ratio),
          -2.0 * log + 4.0 * ratio + ratio * ratio};
}

}  // namespace tendril::contact
