#include <tendril/scene/summary.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace tendril::scene {
namespace {

/// Keys stay in the order they were set.
using OrderedJson = nlohmann::ordered_json;

OrderedJson to_json(const Energies& e) {
  return {{"kinetic", e.kinetic}, {"elastic", e.elastic}, {"potential", e.potential}, {"total", e.total()}};
}

OrderedJson to_json(const bind::BindReport& report, std::size_t points, std::size_t still) {
  return {{"points", points},
          {"out_of_reach", still},
          {"rest_error", report.rest_error},
          {"largest_gap", report.largest_gap},
          {"beyond_ends", report.beyond_ends},
          {"ambiguous", report.ambiguous.size()},
          {"gated", report.gated.size()},
          {"shares", report.shares},
          {"past_focus", report.past_focus.size()},
          {"degenerate", report.degenerate.size()}};
}

OrderedJson finite_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson();
}

std::vector<std::string> left_out(const SceneRun& run) {
  std::vector<std::string> out = run.system().left_out();
  if (run.mesh() == nullptr) out.emplace_back("mesh, binding and frames: the scene names no mesh");
  return out;
}

OrderedJson energy_of(const Report& report) {
  return {{"first", to_json(report.first)},
          {"last", to_json(report.last)},
          {"work", report.work},
          {"imbalance", finite_or_null(report.imbalance)}};
}

void add_steps(OrderedJson& out, const SceneFile& file, const Report& report) {
  out["status"] = to_string(report.stop);
  out["reason"] = report.reason;
  out["integrator"] = report.method;
  for (const Switch& entry : report.switches)
    out["switches"].push_back({{"time", entry.time}, {"to", entry.to}, {"reason", entry.reason}});
  if (file.options.fixed_step) out["fixed_step"] = *file.options.fixed_step;
  out["time"] = report.time;
  out["duration"] = file.duration;
  out["tolerance"] = file.options.tolerance;
  out["steps_accepted"] = report.accepted;
  out["steps_rejected"] = report.rejected;
  out["rhs_evaluations"] = report.evaluations;
  out["smallest_step"] = report.smallest_step;
  out["largest_step"] = report.largest_step;
  out["largest_frequency"] = finite_or_null(report.largest_frequency);
  out["guard_step"] = finite_or_null(report.guard_step);
  out["energy"] = energy_of(report);
}

void add_scene(OrderedJson& out, const SceneFile& file, const System& system) {
  out["units"] = file.units.empty() ? OrderedJson() : OrderedJson(file.units);
  out["curve_pairs"] = file.names;
  out["masses"] = system.node_count();
  out["twist_states"] = system.twist_count();
  out["joints"] = file.joint_places.size();
  out["anchors"] = file.anchor_places.size();
  out["forces"] = file.force_places.size();
  if (!file.bodies.empty()) {
    out["bodies"] = OrderedJson::array();
    for (const SceneBody& body : file.bodies) out["bodies"].push_back(body.name);
  }
}

void add_mesh(OrderedJson& out, const BoundMesh* bound) {
  out["mesh"] = OrderedJson();
  out["binding"] = OrderedJson();
  if (bound == nullptr) return;
  const std::size_t points = bound->mesh().points.size();
  out["mesh"] = {{"points", points}, {"faces", bound->mesh().face_count()}};
  out["binding"] = to_json(bound->binding().report(), points, bound->out_of_reach().size());
}

/// Where the largest zone is, of the mesh at rest.
OrderedJson to_json(const SpoiltMoment& moment) {
  const bind::Distortion& d = moment.what;
  OrderedJson out{{"time", moment.time},
                  {"spoilt_area", d.spoilt},
                  {"folded", d.folded},
                  {"stretched", d.stretched},
                  {"crushed", d.crushed},
                  {"most_stretch", d.most_stretch},
                  {"least_stretch", d.least_stretch},
                  {"zone_count", d.zones.size()}};
  if (d.zones.empty()) return out;
  const Vec3& at = d.zones.front().centre;
  out["zone"] = {{"centre", {at.x(), at.y(), at.z()}}, {"radius", d.zones.front().radius}};
  return out;
}

OrderedJson wall(const RunNotes& notes) {
  OrderedJson out;
  double total = 0.0;
  for (const auto& [phase, seconds] : notes.wall_seconds) {
    out[phase] = seconds;
    total += seconds;
  }
  out["total"] = total;
  return out;
}

}  // namespace

std::string summary_json(const SceneRun& run, const Report& report, const RunNotes& notes) {
  OrderedJson out;
  add_steps(out, run.file(), report);
  add_scene(out, run.file(), run.system());
  add_mesh(out, run.mesh());
  if (notes.spoilt) out["distortion"] = to_json(*notes.spoilt);
  out["left_out"] = left_out(run);
  out["outputs"] = run.outputs();
  out["files"] = notes.files;
  if (!notes.wall_seconds.empty()) out["wall_s"] = wall(notes);
  return out.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace tendril::scene
