#include "rig/rig.h"

#include <tendril/base/number.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tendril::runner {
namespace {

constexpr double kPeriods = 4.0;  // of the slowest limb, that the scene lasts
constexpr double kGust = 0.5, kGustFrequency = 0.7;

/// Numbers as short as a reader needs: lengths to a millionth of the mesh, others to three digits.
class Writer {
 public:
  explicit Writer(double size) : quantum_(std::pow(10.0, std::floor(std::log10(size)) - 6.0)) {}

  std::string length(double x) const { return shortest(round_to(x, quantum_)); }
  std::string point(const Vec3& p) const {
    return "[" + length(p.x()) + ", " + length(p.y()) + ", " + length(p.z()) + "]";
  }
  static std::string number(double x) {
    return x == 0.0 ? "0" : shortest(round_to(x, std::pow(10.0, std::floor(std::log10(std::abs(x))) - 2.0)));
  }
  static std::string vector(const Vec3& v) {
    // A component that is nothing beside the others is rounding.
    const auto one = [&](double x) { return number(std::abs(x) < 1e-9 * v.norm() ? 0.0 : x); };
    return "[" + one(v.x()) + ", " + one(v.y()) + ", " + one(v.z()) + "]";
  }

 private:
  /// Dividing by a whole power of ten keeps the decimal short.
  static double round_to(double x, double quantum) {
    return quantum < 1.0 ? std::round(x / quantum) / std::round(1.0 / quantum)
                         : std::round(x / quantum) * quantum;
  }
  double quantum_;
};

/// Items in lines of at most 110 columns.
std::string filled(const std::vector<std::string>& items, const std::string& indent) {
  std::string out, line = indent;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string item = items[i] + (i + 1 < items.size() ? "," : "");
    if (line.size() > indent.size() && line.size() + 1 + item.size() > 110) {
      out += line + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + item;
  }
  return out + line + "\n";
}

std::string points_text(const std::vector<Vec3>& points, const Writer& write) {
  std::vector<std::string> items;
  for (const Vec3& p : points) items.push_back(write.point(p));
  return "[\n" + filled(items, "        ") + "      ]";
}

std::string sizes_text(const std::vector<RigSection>& sections, double RigSection::*size) {
  std::vector<std::string> items;
  for (const RigSection& s : sections) items.push_back(Writer::number(s.*size));
  return "[\n" + filled(items, "          ") + "        ]";
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump();
}

std::string anchors_text(const Rig& rig, std::size_t curve) {
  std::string out;
  for (const Held& held : rig.held) {
    if (held.curve != curve) continue;
    out += (out.empty() ? "" : ", ") + std::string("{\"nodes\": [") + std::to_string(held.first) + ", " +
           std::to_string(held.last) + "], \"hold\": \"both\"}";
  }
  return out.empty() ? "" : ",\n      \"anchors\": [" + out + "]";
}

/// Kelvin-Voigt's beta that gives a swing of that period the material's loss: 2 pi beta / T = loss.
double viscosity(const Rig& rig) {
  return rig.material.loss * rig.load.period / (2.0 * M_PI);
}

std::string curve_text(const Rig& rig, std::size_t k, const Writer& write) {
  const RigCurve& curve = rig.curves[k];
  const auto unseen = std::count_if(rig.body.sections[k].begin(), rig.body.sections[k].end(),
                                    [](const auto& s) { return !s.seen; });
  std::string out = "    {\n      \"name\": " + quoted(curve.name) + ",\n";
  if (curve.joint)
    out += "      \"joint\": {\"curve_pair\": " + quoted(rig.curves[curve.joint->parent].name) +
           ", \"node\": " + std::to_string(curve.joint->node) + "},\n";
  out += "      \"points\": " + points_text(curve.points, write) + ",\n";
  out += "      \"orientation\": " + points_text(curve.orientation, write) + ",\n";
  out += "      \"material\": {\"young\": " + Writer::number(rig.material.young * rig.unit) +
         ", \"poisson\": " + Writer::number(rig.material.poisson) +
         ", \"density\": " + Writer::number(rig.density) + "},\n";
  if (unseen > 0)
    out += "      // At " + std::to_string(unseen) +
           " of its nodes the mesh shows no section of its own: taken from others, or from the body it is "
           "joined to.\n";
  out += "      \"section\": {\n        \"type\": \"elliptic\",\n        \"a\": " +
         sizes_text(rig.body.sections[k], &RigSection::a) +
         ",\n        \"b\": " + sizes_text(rig.body.sections[k], &RigSection::b) + "\n      },\n";
  out += "      \"viscosity\": " + Writer::number(viscosity(rig));
  return out + anchors_text(rig, k) + "\n    }";
}

std::string weight_text(const Rig& rig) {
  std::string out = "//   weight    " + Writer::number(rig.mass) + " kg, ";
  if (rig.body.volume == 0.0) return out + "that of the rods, since the mesh is not closed\n";
  return out + "from the mesh's volume; the rods overlap where they are joined and have " +
         Writer::number(rig.overlap) + " times it,\n//             so their density is divided by that\n";
}

/// What stands behind `//` ends with its line.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

std::string heading(const Rig& rig, const std::string& command) {
  const std::string unit = Writer::number(rig.unit);
  std::string out = "// Made by: " + on_one_line(command) + "\n";
  out += "// Edit it as you like; what was guessed:\n";
  out += "//   size      " + Writer::number(rig.size) +
         " m along its largest extent, a unit of the mesh is " + unit + " m (--size" +
         (rig.size_given ? "" : "; by default so that it stands, at most 1 m") + ")\n";
  out += "//   material  " + std::string(rig.material.name) + ": " + rig.material.what + ", E " +
         Writer::number(rig.material.young) + " Pa, " + Writer::number(rig.material.density) + " kg/m^3, " +
         rig.material.source + " (--material)\n";
  out += weight_text(rig);
  out += "//   up        " + direction_name(rig.stance.up) + (rig.up_guessed ? ", by its feet (--up)" : "") +
         "\n";
  out += "//   held      " +
         (rig.held_as == "feet" ? std::to_string(rig.held.size()) + " feet" : rig.held_as) + " (--hold)\n";
  out += "//   motion    " + rig.load.slowest + " is the slowest limb: a period of about " +
         Writer::number(rig.load.period) + " s; limbs sag by up to " + Writer::number(100.0 * rig.load.sag) +
         " % of their length\n";
  return out;
}

std::string simulation_text(const Rig& rig) {
  const double duration = std::clamp(kPeriods * rig.load.period, 1.0, 8.0);
  const double rounded = std::ceil(2.0 * duration) / 2.0;
  return "  \"simulation\": {\"duration\": " + Writer::number(rounded) +
         ", \"tolerance\": 1e-3, \"method\": \"automatic\", \"frames\": " +
         std::to_string(static_cast<int>(25.0 * rounded) + 1) + "},\n";
}

}  // namespace

std::string scene_text(const Rig& rig, const std::string& mesh_path, const std::string& command) {
  const Vec3& up = rig.stance.up;
  const Writer write(rig.stance.height);
  std::string out = heading(rig, command) + "{\n  \"version\": 1,\n";
  out += "  \"units\": {\"length\": " + quoted(rig.unit == 1.0 ? "m" : Writer::number(rig.unit) + " m") +
         ", \"mass\": \"kg\", \"time\": \"s\"},\n";
  out += "  \"mesh\": " + quoted(mesh_path) + ",\n  \"curve_pairs\": [\n";
  for (std::size_t k = 0; k < rig.curves.size(); ++k)
    out += curve_text(rig, k, write) + (k + 1 < rig.curves.size() ? ",\n" : "\n");
  out += "  ],\n  \"forces\": [\n    {\"type\": \"gravity\", \"acceleration\": " +
         Writer::vector(Vec3(-kGravity / rig.unit * up)) + "}";
  if (rig.wind_speed > 0.0)
    out += ",\n    // " + Writer::number(rig.wind_speed) +
           " m/s, across the first curve (--wind)\n    {\"type\": \"wind\", \"mean\": " +
           Writer::vector(rig.wind) + ", \"gust\": " + Writer::number(kGust) +
           ", \"gust_frequency\": " + Writer::number(kGustFrequency) +
           ", \"air_density\": " + Writer::number(kAirDensity * std::pow(rig.unit, 3)) + "}";
  out += "\n  ],\n" + simulation_text(rig);
  out += "  \"picture\": {\"up\": " + Writer::vector(up) + ", \"pitch\": 8}\n}\n";
  return out;
}

}  // namespace tendril::runner
