#include "scene/read/anchor_reader.h"

#include "scene/motion/table.h"
#include "scene/read/rod_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace tendril::scene {
namespace {

/// sin(2 pi frequency t + phase), or t where even, and its rate.
struct Wave {
  double frequency = 0.0, phase = 0.0;
  bool even = false;

  double value(double t) const { return even ? t : std::sin(2.0 * std::numbers::pi * frequency * t + phase); }
  double rate(double t) const {
    if (even) return 1.0;
    const double omega = 2.0 * std::numbers::pi * frequency;
    return omega * std::cos(omega * t + phase);
  }
  double period() const {
    return frequency > 0.0 ? 1.0 / frequency : std::numeric_limits<double>::infinity();
  }
};

struct Motion {
  Vec3 rest = Vec3::Zero();
  Frame frame;
  Vec3 shift = Vec3::Zero();  ///< amplitude of the translation
  Wave shift_wave;
  TimeTable shifts;  ///< instead of the wave, unless empty
  Vec3 axis = Vec3::UnitZ(), about = Vec3::Zero();
  double angle = 0.0;  ///< amplitude of the rotation [rad]
  Wave angle_wave;
  TimeTable angles;  ///< their x instead of the wave, unless empty

  Vec3 shift_at(double t) const { return shifts.empty() ? shift * shift_wave.value(t) : shifts.value(t); }
  Vec3 shift_rate(double t) const { return shifts.empty() ? shift * shift_wave.rate(t) : shifts.rate(t); }
  double angle_at(double t) const {
    return angles.empty() ? angle * angle_wave.value(t) : angles.value(t).x();
  }
  double angle_rate(double t) const {
    return angles.empty() ? angle * angle_wave.rate(t) : angles.rate(t).x();
  }

  AnchorPose operator()(double t) const {
    const auto turned = [&](const Vec3& v) { return rotate_about(axis, angle_at(t), v); };
    const Vec3 arm = turned(rest - about);
    AnchorPose pose;
    pose.angular_velocity = axis * angle_rate(t);
    pose.position = about + arm + shift_at(t);
    pose.velocity = pose.angular_velocity.cross(arm) + shift_rate(t);
    pose.frame = {turned(frame.x), turned(frame.y), turned(frame.z)};
    return pose;
  }
  double period() const {
    double turns =
        angle_wave.even && angle != 0.0 ? 2.0 * std::numbers::pi / std::abs(angle) : angle_wave.period();
    if (!angles.empty()) turns = angles.period();
    return std::min(turns, shifts.empty() ? shift_wave.period() : shifts.period());
  }
};

Wave read_swing(const JsonNode& node) {
  return {node.at("frequency").not_negative(), node.number_or("phase", 0.0), false};
}

/// Either swings, with amplitude and frequency, or goes on evenly at `rate`.
/// \return  the name of the size
const char* read_wave(const JsonNode& node, const char* rate, Wave& wave) {
  if (node.has(rate) == node.has("amplitude"))
    node.refuse(std::string("amplitude and ") + rate, "one of them, not both");
  if (node.has(rate)) {
    if (node.has("frequency") || node.has("phase"))
      node.refuse(std::string("frequency or phase beside ") + rate, "an even motion");
    wave = {0.0, 0.0, true};
    return rate;
  }
  wave = read_swing(node);
  return "amplitude";
}

/// A motion by a table is given by nothing else.
TimeTable read_motion_table(const JsonNode& node, std::size_t width) {
  for (const char* key : {"amplitude", "velocity", "rate", "frequency", "phase"})
    if (node.has(key)) node.at(key).refuse("beside a table", "a table alone");
  return read_table(node.at("table"), width);
}

struct Rotation {
  Vec3 axis;
  double angle;
  Wave wave;
  TimeTable table;
  std::optional<Vec3> about;
};

Rotation read_rotation(const JsonNode& node) {
  const Vec3 axis = node.at("axis").vec3();
  const double length = axis.stableNorm();
  if (!(length > 0.0) || !std::isfinite(length))
    node.at("axis").refuse("no direction", "a vector that is not zero");
  Rotation out{axis / length, 0.0, {}, {}, std::nullopt};
  if (node.has("table"))
    out.table = read_motion_table(node, 1);
  else
    out.angle = node.at(read_wave(node, "rate", out.wave)).number();
  if (node.has("about")) out.about = node.at("about").vec3();
  return out;
}

struct Range {
  std::size_t first, last;
};

Range read_range(const JsonNode& anchor, const Rod& rod) {
  if (anchor.has("node") == anchor.has("nodes")) anchor.refuse("node and nodes", "one of them, not both");
  if (anchor.has("node")) {
    const std::size_t node = read_node(anchor.at("node"), rod);
    return {node, node};
  }
  const JsonNode nodes = anchor.at("nodes");
  const Range range{read_node(nodes.at(0), rod), read_node(nodes.at(1), rod)};
  if (range.first > range.last) nodes.refuse("a range that ends before it starts", "[first, last]");
  return range;
}

/// Along a line, or in the plane across a direction.
void read_slide(const JsonNode& slide, const std::string& hold, Anchor& out) {
  if (slide.has("along") == slide.has("across")) slide.refuse("along and across", "one of them, not both");
  if (hold == "frame") slide.refuse("beside a hold of the frame alone", "a hold of \"position\" or \"both\"");
  const JsonNode axis = slide.at(slide.has("along") ? "along" : "across");
  out.slide = slide.has("along") ? Anchor::Slide::line : Anchor::Slide::plane;
  out.slide_axis = axis.vec3();
  if (!(out.slide_axis.stableNorm() > 0.0)) axis.refuse("no direction", "a vector that is not zero");
}

void read_swivel(const JsonNode& axis, const std::string& hold, Anchor& out) {
  if (hold == "position")
    axis.refuse("beside a hold of the position alone", "a hold of \"frame\" or \"both\"");
  out.swivels = true;
  out.swivel_axis = axis.vec3();
  if (!(out.swivel_axis.stableNorm() > 0.0)) axis.refuse("no direction", "a vector that is not zero");
}

}  // namespace

ReadMotion read_motion(const JsonNode& node, const Vec3& rest, const Frame& frame) {
  if (!node.has("translation") && !node.has("rotation")) return {};
  Motion motion;
  motion.rest = motion.about = rest;
  motion.frame = frame;
  if (node.has("translation")) {
    const JsonNode way = node.at("translation");
    if (way.has("table"))
      motion.shifts = read_motion_table(way, 3);
    else
      motion.shift = way.at(read_wave(way, "velocity", motion.shift_wave)).vec3();
  }
  if (node.has("rotation")) {
    const Rotation rotation = read_rotation(node.at("rotation"));
    motion.axis = rotation.axis;
    motion.angle = rotation.angle;
    motion.angle_wave = rotation.wave;
    motion.angles = rotation.table;
    motion.about = rotation.about.value_or(rest);
  }
  return {motion, motion.period()};
}

std::vector<Anchor> read_anchors(const JsonNode& anchor, std::size_t rod_index, const Rod& rod) {
  const Range range = read_range(anchor, rod);
  const std::string hold = anchor.text_or("hold", "both");
  const NodeFrames frames = node_frames(rod.p, rod.q);
  std::vector<Anchor> out;
  for (std::size_t i = range.first; i <= range.last; ++i) {
    Anchor one{rod_index, i, hold != "frame", hold != "position", {}};
    if (anchor.has("until")) one.until = anchor.at("until").number();
    if (anchor.has("slide")) read_slide(anchor.at("slide"), hold, one);
    if (anchor.has("swivel")) read_swivel(anchor.at("swivel"), hold, one);
    const ReadMotion motion = read_motion(anchor, rod.p[i], frames.frame[i]);
    one.motion = motion.pose;
    one.period = motion.period;
    out.push_back(one);
  }
  return out;
}

}  // namespace tendril::scene
