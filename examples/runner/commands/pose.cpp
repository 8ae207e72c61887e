#include "commands.h"

#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/scene/curve_file.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

namespace tendril::runner {
namespace {

using Json = nlohmann::ordered_json;

struct PoseArguments {
  std::string axis, out;
  std::vector<std::string> bends, twists;
};

/// A curve of the file, at rest and posed.
struct Limb {
  std::string name;
  std::vector<Vec3> p, q;          ///< at rest: points and orientation points
  std::vector<Mat3> turn;          ///< of each node, from rest to the pose
  std::vector<Vec3> posed, side;   ///< points and orientation points
  double bend = 0.0, twist = 0.0;  ///< [rad]
};

std::string names_of(const std::vector<Limb>& limbs) {
  std::string out;
  for (const Limb& limb : limbs) out += (out.empty() ? "" : ", ") + limb.name;
  return out;
}

/// NAME:DEGREES, the name up to the last colon; of one curve DEGREES alone.
void set(const std::string& option, const std::string& text, std::vector<Limb>& limbs, double Limb::*angle) {
  const std::size_t colon = text.rfind(':');
  const bool alone = colon == std::string::npos && limbs.size() == 1;
  const std::size_t from = alone ? 0 : colon + 1;
  double degrees = 0.0;
  const char* end = text.data() + text.size();
  const bool number = (alone || colon != std::string::npos) && from < text.size() &&
                      std::from_chars(text.data() + from, end, degrees).ptr == end;
  if (!number || !(std::abs(degrees) <= 1e6)) throw InvalidInput(option, "'" + text + "'", "NAME:DEGREES");
  const std::string name = alone ? limbs[0].name : text.substr(0, colon);
  const auto limb = std::find_if(limbs.begin(), limbs.end(), [&](const Limb& l) { return l.name == name; });
  if (limb == limbs.end()) throw InvalidInput(option, "no curve is called '" + name + "'", names_of(limbs));
  (*limb).*angle += degrees * M_PI / 180.0;
}

std::vector<Limb> read_limbs(const std::vector<scene::CurveFile>& files) {
  std::vector<Limb> limbs;
  for (const scene::CurveFile& file : files) {
    if (!file.through) throw InvalidInput(file.place, "control points", "a chain of points");
    Limb limb;
    limb.name = file.name.empty() ? std::to_string(limbs.size()) : file.name;
    limb.p = file.masses;
    for (const double t : file.through->parameters()) limb.q.push_back(file.pair.orientation().value(t));
    limbs.push_back(std::move(limb));
  }
  return limbs;
}

Mat3 rotation(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Of each node, its length along the curve over the whole.
std::vector<double> parts_along(const std::vector<Vec3>& p) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < p.size(); ++i) along.push_back(along.back() + (p[i] - p[i - 1]).norm());
  const double length = along.back();
  for (double& part : along) part /= length;
  return along;
}

/// Bends evenly towards the side that the orientation points are on, and twists evenly, from a start that
/// is given. Edges are chords of the arc, each turned as the arc is at its middle: the end is off the arc's
/// by the square of an edge's angle.
void pose(Limb& limb, const Vec3& start, const Mat3& from) {
  const std::vector<Frame> frames = node_frames(limb.p, limb.q).frame;
  const std::vector<double> part = parts_along(limb.p);
  const Vec3 about = -frames.front().x;
  limb.posed = {start};
  for (std::size_t i = 1; i < limb.p.size(); ++i)
    limb.posed.push_back(limb.posed.back() + from *
                                                 rotation(about, limb.bend * 0.5 * (part[i - 1] + part[i])) *
                                                 (limb.p[i] - limb.p[i - 1]));
  for (std::size_t i = 0; i < limb.p.size(); ++i) {
    limb.turn.push_back(from * rotation(about, limb.bend * part[i]) *
                        rotation(frames[i].z, limb.twist * part[i]));
    limb.side.push_back(limb.posed[i] + limb.turn[i] * (limb.q[i] - limb.p[i]));
  }
}

/// In the order of the file, where a curve stands behind the one it is joined to.
void pose_all(const Json& curves, std::vector<Limb>& limbs) {
  for (std::size_t k = 0; k < limbs.size(); ++k) {
    Vec3 start = limbs[k].p.front();
    Mat3 from = Mat3::Identity();
    if (curves[k].contains("joint")) {
      const std::string parent = curves[k]["joint"]["curve_pair"];
      const auto end = limbs.begin() + static_cast<std::ptrdiff_t>(k);
      const auto at = std::find_if(limbs.begin(), end, [&](const Limb& l) { return l.name == parent; });
      const std::size_t node = curves[k]["joint"]["node"];
      if (at == end || node >= at->p.size())
        throw InvalidInput("joint of '" + limbs[k].name + "'",
                           "node " + std::to_string(node) + " of '" + parent + "'",
                           "a node of a curve before it");
      from = at->turn[node];
      start = at->posed[node] + from * (start - at->p[node]);
    }
    pose(limbs[k], start, from);
  }
}

void require_frames(const Limb& limb, const scene::CurveFile& rest) {
  const Interpolator& fit = *rest.through;
  const CurvePair pair(fit.knots(), fit.solve(limb.posed), fit.solve(limb.side));
  if (const auto jump = find_frame_jump(pair, fit.parameters()))
    throw InvalidInput("'" + limb.name + "'", describe(*jump, "nodes"), "a smaller angle, or more nodes");
}

Json array_of(const std::vector<Vec3>& points) {
  Json out = Json::array();
  for (const Vec3& p : points) out.push_back(Json::array({p.x(), p.y(), p.z()}));
  return out;
}

/// One curve a line, where the file has several.
std::string text_of(const Json& file) {
  if (!file.contains("curves")) return file.dump() + "\n";
  std::string text = "{\"version\": 1, \"curves\": [";
  for (std::size_t k = 0; k < file["curves"].size(); ++k)
    text += (k == 0 ? "\n" : ",\n") + file["curves"][k].dump();
  return text + "\n]}\n";
}

int run_pose(const PoseArguments& options) {
  const std::vector<scene::CurveFile> rest = scene::read_curves(options.axis);
  std::vector<Limb> limbs = read_limbs(rest);
  for (const std::string& text : options.bends) set("--bend", text, limbs, &Limb::bend);
  for (const std::string& text : options.twists) set("--twist", text, limbs, &Limb::twist);
  Json file = Json::parse(read_file(options.axis), nullptr, true, true);
  Json alone = Json::array({file});
  Json& curves = file.contains("curves") ? file["curves"] : alone;
  pose_all(curves, limbs);
  for (std::size_t k = 0; k < limbs.size(); ++k) {
    require_frames(limbs[k], rest[k]);
    curves[k]["points"] = array_of(limbs[k].posed);
    curves[k]["orientation"] = array_of(limbs[k].side);
  }
  write_file_whole(options.out, text_of(file.contains("curves") ? file : alone[0]));
  std::cout << options.out << ": " << limbs.size() << " curve(s): " << names_of(limbs) << '\n';
  return kDone;
}

}  // namespace

Command pose_command(CLI::App& parent) {
  auto* app = parent.add_subcommand(
      "pose", "Bends and twists the curve-pairs of a file; what is joined to them goes along");
  const auto options = std::make_shared<PoseArguments>();
  app->add_option("axis", options->axis, "curve file (JSON) at rest, of one or several chains of points")
      ->required();
  app->add_option("--bend", options->bends,
                  "NAME:DEGREES, of one curve DEGREES, evenly along the curve, towards its orientation side; "
                  "its start, and the way it sets out, stay; one --bend for each curve, those of one add up")
      ->allow_extra_args(false);
  app->add_option("--twist", options->twists,
                  "NAME:DEGREES at its end, evenly from none at its start; one --twist for each curve")
      ->allow_extra_args(false);
  app->add_option("--out", options->out, "curve file (JSON) to write")->required();
  return {app, [options] { return run_pose(*options); }};
}

}  // namespace tendril::runner
