#include "scene/json/units.h"

#include <charconv>
#include <cmath>

namespace tendril::scene {
namespace {

using Words = std::map<std::string, double>;

const Words& lengths() {
  static const Words words{{"m", 1.0},
                           {"metre", 1.0},
                           {"meter", 1.0},
                           {"metres", 1.0},
                           {"meters", 1.0},
                           {"km", 1e3},
                           {"kilometre", 1e3},
                           {"kilometer", 1e3},
                           {"kilometres", 1e3},
                           {"kilometers", 1e3},
                           {"dm", 1e-1},
                           {"cm", 1e-2},
                           {"centimetre", 1e-2},
                           {"centimeter", 1e-2},
                           {"centimetres", 1e-2},
                           {"centimeters", 1e-2},
                           {"mm", 1e-3},
                           {"millimetre", 1e-3},
                           {"millimeter", 1e-3},
                           {"millimetres", 1e-3},
                           {"millimeters", 1e-3},
                           {"um", 1e-6},
                           {"\u00b5m", 1e-6},
                           {"\u03bcm", 1e-6},
                           {"micrometre", 1e-6},
                           {"micrometer", 1e-6},
                           {"nm", 1e-9},
                           {"in", 0.0254},
                           {"inch", 0.0254},
                           {"inches", 0.0254},
                           {"ft", 0.3048},
                           {"foot", 0.3048},
                           {"feet", 0.3048}};
  return words;
}
const Words& masses() {
  static const Words words{
      {"kg", 1.0},           {"kilogram", 1.0},      {"kilograms", 1.0},   {"g", 1e-3},
      {"gram", 1e-3},        {"grams", 1e-3},        {"mg", 1e-6},         {"t", 1e3},
      {"tonne", 1e3},        {"tonnes", 1e3},        {"lb", 0.45359237},   {"lbs", 0.45359237},
      {"pound", 0.45359237}, {"pounds", 0.45359237}, {"slug", 14.59390294}};
  return words;
}
const Words& times() {
  static const Words words{
      {"s", 1.0},        {"sec", 1.0},          {"second", 1.0},        {"seconds", 1.0},
      {"ms", 1e-3},      {"millisecond", 1e-3}, {"milliseconds", 1e-3}, {"us", 1e-6},
      {"\u00b5s", 1e-6}, {"\u03bcs", 1e-6},     {"min", 60.0},          {"minute", 60.0},
      {"minutes", 60.0}, {"h", 3600.0},         {"hour", 3600.0},       {"hours", 3600.0}};
  return words;
}

/// "mm", or a number and a word.
std::optional<double> value_of(const std::string& text, const Words& words) {
  const std::size_t word = text.find_last_of(" \t");
  const auto known = words.find(word == std::string::npos ? text : text.substr(word + 1));
  if (known == words.end()) return std::nullopt;
  if (word == std::string::npos) return known->second;
  const char* const end = text.data() + text.find_last_not_of(" \t", word) + 1;
  double count = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc{} || stop != end || !(count > 0.0) || !std::isfinite(count)) return std::nullopt;
  return count * known->second;
}

}  // namespace

std::optional<Units> units_of(const std::map<std::string, std::string>& words) {
  if (words.empty()) return Units{};
  Units units;
  const auto read = [&](const char* what, const Words& known, double& value) {
    const auto given = words.find(what);
    const std::optional<double> found = given != words.end() ? value_of(given->second, known) : std::nullopt;
    value = found.value_or(0.0);
    return found.has_value();
  };
  const bool all = read("length", lengths(), units.length) && read("mass", masses(), units.mass) &&
                   read("time", times(), units.time);
  return all ? std::optional(units) : std::nullopt;
}

}  // namespace tendril::scene
