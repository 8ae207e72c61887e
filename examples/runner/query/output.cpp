#include "query/output.h"

#include <algorithm>
#include <cstdio>

namespace tendril::runner {
namespace {

using exact::Answer;
using exact::Meeting;
using exact::Relation;

constexpr std::size_t kShown = 6;  ///< triangles in a line of the table

OrderedJson reason_of(const Answer& answer) {
  return answer.relation == Relation::undecidable ? OrderedJson(to_string(answer.reason)) : OrderedJson();
}

/// The words of a side: hit is inside.
const char* side_of(const Answer& side) {
  switch (side.relation) {
    case Relation::hit:
      return "inside";
    case Relation::touching:
      return "on";
    case Relation::free:
      return "outside";
    case Relation::undecidable:
      break;
  }
  return "undecidable";
}

OrderedJson about(const Target& target) {
  OrderedJson out{{"mesh", target.file}, {"triangles", target.face.size()}, {"closed", target.closed()}};
  out["out_of_reach"] = target.out_of_reach;
  out["cells"] = out["cells_deformed"] = nullptr;
  if (const auto* bound = std::get_if<exact::BoundSurface>(&target.surface)) {
    out["cells"] = bound->work().cells;
    out["cells_deformed"] = bound->work().placed;
  }
  return out;
}

OrderedJson distance_of(const exact::Distance& d) {
  return {{"lower", d.lower}, {"upper", d.upper}};
}

OrderedJson triangles_of(const Target& target, const std::vector<Meeting>& meetings) {
  OrderedJson out = OrderedJson::array();
  for (const Meeting& m : meetings)
    out.push_back(
        {{"triangle", m.triangle}, {"face", target.face[m.triangle]}, {"relation", to_string(m.relation)}});
  return out;
}

OrderedJson to_json(const Target& target, const Finding& f) {
  const bool free = f.surface.relation == Relation::free;
  OrderedJson out{{"query", f.query},
                  {"answer", to_string(f.answer.relation)},
                  {"reason", reason_of(f.answer)},
                  {"surface", to_string(f.surface.relation)},
                  {"side", side_of(f.side.answer)},
                  {"winding", free ? OrderedJson(f.side.winding) : OrderedJson()},
                  {"distance", distance_of(f.nearest.distance)},
                  {"nearest_triangle", f.nearest.triangle},
                  {"nearest_face", target.face[f.nearest.triangle]}};
  out["nearest_point"] = free ? runner::to_json(f.nearest.distance.on_b) : OrderedJson();
  out["triangles"] = triangles_of(target, f.meetings);
  return out;
}

OrderedJson to_json(const std::optional<Parts>& parts) {
  if (!parts) return nullptr;
  return {{"inside", parts->within}, {"outside", parts->outside}, {"undecidable", parts->undecidable}};
}

std::string line_about(const Target& t) {
  std::string out = t.file + ": " + std::to_string(t.face.size()) + " triangles, " +
                    (t.closed() ? "closed" : "open: inside and outside are undecidable");
  if (const auto* bound = std::get_if<exact::BoundSurface>(&t.surface))
    out += "; deformed " + std::to_string(bound->work().placed) + " of " +
           std::to_string(bound->work().cells) + " cells";
  if (t.out_of_reach > 0) out += "; " + std::to_string(t.out_of_reach) + " vertices out of reach";
  return out + "\n";
}

std::string words_of(const Answer& answer) {
  std::string out = to_string(answer.relation);
  if (answer.relation == Relation::undecidable) out += std::string(" (") + to_string(answer.reason) + ")";
  return out;
}

std::string list_of(const std::vector<Meeting>& meetings) {
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, meetings.size()); ++i)
    out += (i > 0 ? " " : "") + std::to_string(meetings[i].triangle) +
           (meetings[i].relation == Relation::touching ? "t" : "");
  if (meetings.size() > kShown) out += " and " + std::to_string(meetings.size() - kShown) + " more";
  return meetings.empty() ? "-" : out;
}

std::string line_of(const Finding& f) {
  char text[160];
  std::snprintf(text, sizeof text, "%-14s %-19s %-9s %-12s %14.9g %9u  ", f.query.c_str(),
                words_of(f.answer).c_str(), to_string(f.surface.relation), side_of(f.side.answer),
                f.nearest.distance.upper, f.nearest.triangle);
  return text + list_of(f.meetings) + "\n";
}

std::string line_of(const char* whose, const Parts& parts) {
  return std::string("parts of ") + whose + ": " + std::to_string(parts.within) + " inside, " +
         std::to_string(parts.outside) + " outside, " + std::to_string(parts.undecidable) + " undecidable\n";
}

}  // namespace

const char* to_string(Relation relation) {
  constexpr const char* kNames[] = {"free", "touching", "hit", "undecidable"};
  return kNames[static_cast<int>(relation)];
}

const char* to_string(exact::Reason reason) {
  constexpr const char* kNames[] = {"none", "not_finite", "open", "degenerate", "unbounded", "rounding"};
  return kNames[static_cast<int>(reason)];
}

OrderedJson to_json(const Target& target, const std::vector<Finding>& findings) {
  OrderedJson out = about(target);
  out["queries"] = OrderedJson::array();
  for (const Finding& f : findings) out["queries"].push_back(to_json(target, f));
  return out;
}

OrderedJson to_json(const Target& target, const Target& other, const MeshFinding& found) {
  OrderedJson out = about(target), pairs = OrderedJson::array();
  for (const Meeting& m : found.pairs)
    pairs.push_back({{"triangle", m.triangle},
                     {"face", target.face[m.triangle]},
                     {"other_triangle", m.other},
                     {"other_face", other.face[m.other]},
                     {"relation", to_string(m.relation)}});
  out["other"] = about(other);
  out["answer"] = out["surface"] = to_string(found.surfaces.relation);
  out["distance"] = distance_of(found.nearest.distance);
  out["nearest_triangle"] = found.nearest.triangle;
  out["nearest_other_triangle"] = found.nearest_other;
  out["parts_of_other"] = to_json(found.parts_of_other);
  out["parts_of_mesh"] = to_json(found.parts_of_target);
  out["pairs"] = std::move(pairs);
  return out;
}

std::string to_table(const Target& target, const std::vector<Finding>& findings) {
  char text[160];
  std::snprintf(text, sizeof text, "%-14s %-19s %-9s %-12s %14s %9s  %s\n", "query", "answer", "surface",
                "side", "distance", "nearest", "triangles met (t: touched)");
  std::string out = line_about(target) + text;
  for (const Finding& f : findings) out += line_of(f);
  return out;
}

std::string to_table(const Target& target, const Target& other, const MeshFinding& found) {
  std::string out = line_about(target) + line_about(other);
  out += std::string("surfaces: ") + to_string(found.surfaces.relation) + ", " +
         std::to_string(found.pairs.size()) + " pairs of triangles meet, distance " +
         shortest(found.nearest.distance.upper) + "\n";
  if (found.parts_of_other) out += line_of("the second mesh", *found.parts_of_other);
  if (found.parts_of_target) out += line_of("the first mesh", *found.parts_of_target);
  return out;
}

}  // namespace tendril::runner
