#include "write/summary.h"

#include <cmath>

namespace tendril::runner {
namespace {

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
          {"places", report.places},
          {"past_focus", report.past_focus.size()},
          {"degenerate", report.degenerate.size()}};
}

OrderedJson finite_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson();
}

std::vector<std::string> left_out(const System& system, const bind::Binding* binding) {
  std::vector<std::string> out = system.left_out();
  if (binding == nullptr) out.emplace_back("mesh, binding and frames: the scene names no mesh");
  return out;
}

}  // namespace

OrderedJson summarize(const SceneFile& file, const System& system, const bind::PolygonMesh& mesh,
                      const bind::Binding* binding, const Report& report, const Recorder& recorder) {
  OrderedJson out;
  out["status"] = tendril::to_string(report.stop);
  out["reason"] = report.reason;
  out["integrator"] = report.method;
  for (const tendril::Switch& entry : report.switches)
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
  out["energy"] = {{"first", to_json(report.first)},
                   {"last", to_json(report.last)},
                   {"work", report.work},
                   {"imbalance", finite_or_null(report.imbalance)}};
  out["units"] = file.units;
  out["curve_pairs"] = file.names;
  out["masses"] = system.node_count();
  out["twist_states"] = system.twist_count();
  out["joints"] = file.joint_places.size();
  out["anchors"] = file.anchor_places.size();
  out["forces"] = file.force_places.size();
  out["mesh"] = binding == nullptr
                    ? OrderedJson()
                    : OrderedJson{{"points", mesh.points.size()}, {"faces", mesh.face_count()}};
  out["binding"] =
      binding == nullptr ? OrderedJson() : to_json(binding->report(), binding->size(), recorder.still());
  out["left_out"] = left_out(system, binding);
  out["outputs"] = recorder.outputs();
  out["files"] = recorder.files();
  return out;
}

OrderedJson wall_seconds(const Phases& phases) {
  OrderedJson out;
  double total = 0.0;
  for (std::size_t k = 0; k < Phases::count; ++k) {
    out[Phases::names[k]] = phases.seconds[k];
    total += phases.seconds[k];
  }
  out["total"] = total;
  return out;
}

}  // namespace tendril::runner
