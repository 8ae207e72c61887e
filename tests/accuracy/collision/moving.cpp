#include <tendril/base/file.h>
#include <tendril/collision/query_file.h>
#include <tendril/exact/continuous.h>

#include <cmath>
#include <filesystem>

#include "accuracy/collision/suite.h"
#include "collision/made_queries.h"
#include "support/meeting_truth.h"

// Features that move, straight and on cubics: public queries with their exact answers, made ones against
// root counts in rationals.
namespace tendril::suite {
namespace {

using collision::Features;
using collision::FirstMeeting;
using collision::KnownQuery;
using collision::Meeting;
using collision::Paths;
using test::MeetingTruth;
using test::Ratio;

template <int Degree>
struct Moving {
  Features features;
  Paths<Degree> paths;
  bool meets;
  std::optional<MeetingTruth> when;
  std::string kind;  ///< of what was made up
};

template <int Degree>
using MovingList = std::vector<Moving<Degree>>;

/// Wrong: a first meeting that is not in its bracket, or a bracket wider than 2^-40.
template <int Degree>
void judge_times(const MovingList<Degree>& queries, Row& row) {
  for (const Moving<Degree>& q : queries) {
    const FirstMeeting found = exact::first_meeting<Degree>(q.features, q.paths);
    if (found.meeting != Meeting::hit || !q.meets) continue;
    const double width = found.to - found.from;
    row.error = std::max(row.error.value_or(0.0), width);
    const bool off = q.when && (Ratio(found.from) > q.when->high || Ratio(found.to) < q.when->low);
    row.wrong += off || width > 0x1p-40;
  }
}

template <int Degree, class Ask>
void judge_all(const char* section, const std::string& family, const MovingList<Degree>& queries,
               const Ask& ask_of, std::vector<Row>& rows) {
  std::vector<char> truth;
  for (const Moving<Degree>& q : queries) truth.push_back(q.meets);
  for (const Adapter& adapter : adapters()) {
    const auto ask = ask_of(adapter);
    if (!ask) continue;
    Row row = judge({section, family, adapter.name}, queries, truth, std::vector<char>(queries.size(), 1),
                    [&](const Moving<Degree>& q) { return ask(q.features, q.paths); });
    if (adapter.name == "tendril") judge_times(queries, row);
    rows.push_back(row);
  }
}

const char* word(Features features) {
  return features == Features::edge_edge ? "edge-edge" : "vertex-face";
}

/// Anywhere and as in a mesh's step; facing each other and meeting or missing by little; touching at an end,
/// on whole numbers, in one plane, on one line, with coinciding corners.
std::string group_of(const std::string& kind) {
  if (kind == "anywhere" || kind == "smooth") return "generic";
  if (kind == "parabolas" || kind == "near miss") return "grazing";
  return "special";
}

template <int Degree>
MovingList<Degree> made(Features features, const Settings& settings) {
  test::QueryMaker<Degree> maker(settings.seed * 16 + 2 * Degree + (features == Features::edge_edge));
  MovingList<Degree> out;
  for (long i = 0; i < settings.count; ++i) {
    const auto q = maker.make(features, static_cast<int>(i));
    const MeetingTruth truth = test::MeetingOracle<Degree>(features, q.paths).truth();
    out.push_back({features, q.paths, truth.meets, truth, group_of(q.kind)});
  }
  return out;
}

double rounded_down(const Ratio& t) {
  double x = t.convert_to<double>();
  while (Ratio(x) > t) x = std::nextafter(x, -1.0);
  return std::max(x, 0.0);
}
double rounded_up(const Ratio& t) {
  double x = t.convert_to<double>();
  while (Ratio(x) < t) x = std::nextafter(x, 2.0);
  return std::min(x, 1.0);
}

template <int Degree>
void write_csv(const std::string& folder, const char* kind, Features features,
               const MovingList<Degree>& list) {
  if (folder.empty()) return;
  std::vector<KnownQuery<Degree>> known;
  for (const Moving<Degree>& q : list) {
    KnownQuery<Degree> one{q.paths, q.meets};
    if (q.meets) one.from = rounded_down(q.when->low), one.to = rounded_up(q.when->high);
    known.push_back(one);
  }
  write_file_whole(folder + "/" + kind + "_" + word(features) + ".csv",
                   collision::write_queries<Degree>(known));
}

/// Of all files below a folder whose paths name these features: those of the public sets do.
MovingList<1> public_queries(const std::string& folder, Features features) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  MovingList<1> out;
  for (const auto& file : files) {
    const bool edges = file.string().find("edge-edge") != std::string::npos;
    if (edges != (features == Features::edge_edge)) continue;
    for (const auto& q : collision::read_queries<1>(read_file(file.string()), file.string()))
      out.push_back({features, q.paths, q.meets, {}, "public"});
  }
  return out;
}

/// A row for each group that there is.
template <int Degree, class Ask>
void judge_groups(const char* section, Features features, const MovingList<Degree>& list, const Ask& ask_of,
                  std::vector<Row>& rows) {
  for (const char* group : {"generic", "grazing", "special", "public"}) {
    MovingList<Degree> its;
    for (const Moving<Degree>& q : list)
      if (q.kind == group) its.push_back(q);
    if (!its.empty())
      judge_all<Degree>(section, std::string(group) + " " + word(features), its, ask_of, rows);
  }
}

constexpr Features kFeatures[] = {Features::vertex_face, Features::edge_edge};

}  // namespace

void straight_section(const Settings& settings, std::vector<Row>& rows) {
  for (const Features features : kFeatures) {
    const auto ask = [](const Adapter& a) { return a.straight; };
    const MovingList<1> list = made<1>(features, settings);
    judge_groups<1>("straight", features, list, ask, rows);
    write_csv<1>(settings.csv, "straight", features, list);
    if (settings.data.empty()) continue;
    judge_groups<1>("straight", features, public_queries(settings.data, features), ask, rows);
  }
}

void cubic_section(const Settings& settings, std::vector<Row>& rows) {
  for (const Features features : kFeatures) {
    const MovingList<3> list = made<3>(features, settings);
    judge_groups<3>(
        "cubic", features, list, [](const Adapter& a) { return a.cubic; }, rows);
    write_csv<3>(settings.csv, "cubic", features, list);
  }
}

}  // namespace tendril::suite
