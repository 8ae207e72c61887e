// Times and errors of the continuous tests beside a plain solver in doubles, from one run on one thread, in
// processor time. The public queries come from $TENDRIL_CCD_DATA or ../shared/data/ccd, the cubic ones are
// made here; exact truth in both.
#include <tendril/exact/continuous.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "collision/ccd_data.h"
#include "collision/made_queries.h"
#include "support/meeting_truth.h"

namespace tendril {
namespace {

using collision::Features;
using collision::FirstMeeting;
using collision::Meeting;
using collision::Paths;

template <int Degree>
struct Query {
  Features features;
  Paths<Degree> paths;
  bool meets;
};

template <int Degree>
Vec3 at(const std::array<Vec3, Degree + 1>& path, double t) {
  std::array<Vec3, Degree + 1> p = path;
  for (int level = Degree; level > 0; --level)
    for (int i = 0; i < level; ++i) p[i] += t * (p[i + 1] - p[i]);
  return p[0];
}

/// What is commonly done: roots of the determinant from its changes of sign on a fine net of times, halved,
/// and a test of the inside there, without any bound on rounding.
template <int Degree>
FirstMeeting plain(Features features, const Paths<Degree>& paths) {
  std::array<Vec3, 3> d;
  const auto volume = [&](double t) {
    const Vec3 first = at<Degree>(paths[0], t);
    for (int i = 0; i < 3; ++i) d[i] = at<Degree>(paths[i + 1], t) - first;
    return d[0].dot(d[1].cross(d[2]));
  };
  const auto inside = [&] {
    const bool edges = features == Features::edge_edge;
    const Vec3 normal = edges ? d[0].cross(d[2] - d[1]) : (d[1] - d[0]).cross(d[2] - d[0]);
    const double w1 = normal.dot(d[1].cross(d[2]));
    const double w2 = normal.dot(d[2].cross(d[0]));
    const double w3 = normal.dot(d[0].cross(d[1]));
    return edges ? std::min({w1, -w2, -w3, -(w1 + w2 + w3)}) >= 0 : std::min({w1, w2, w3}) >= 0;
  };
  constexpr int steps = Degree == 1 ? 8 : 24;
  double before = volume(0.0);
  for (int i = 0; i < steps; ++i) {
    const double after = volume((i + 1.0) / steps);
    if (before * after <= 0.0) {
      double low = i / (1.0 * steps);
      double high = (i + 1.0) / steps;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (low + high);
        (volume(middle) * before > 0.0 ? low : high) = middle;
      }
      volume(high);
      if (inside()) return {Meeting::hit, collision::Reason::none, low, high};
    }
    before = after;
  }
  return {Meeting::free, collision::Reason::none, 1.0, 1.0};
}

template <int Degree>
void measure(const char* set, const char* name, const std::vector<Query<Degree>>& queries,
             FirstMeeting (*test)(Features, const Paths<Degree>&)) {
  int missed = 0, invented = 0, undecided = 0, wide = 0;
  for (const auto& q : queries) {
    const FirstMeeting found = test(q.features, q.paths);
    undecided += found.meeting == Meeting::undecided;
    missed += q.meets && found.meeting == Meeting::free;
    invented += !q.meets && found.meeting == Meeting::hit;
    wide += found.meeting == Meeting::hit && found.to - found.from > 0x1p-40;
  }
  double best = 1e300;
  for (int round = 0; round < 5; ++round) {
    const std::clock_t start = std::clock();
    volatile int hits = 0;
    for (const auto& q : queries) hits = hits + (test(q.features, q.paths).meeting == Meeting::hit);
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::printf("%-10s %-22s %8zu %8d %8d %9d %6d %9.3f\n", set, name, queries.size(), missed, invented,
              undecided, wide, best / static_cast<double>(queries.size()) * 1e6);
}

template <int Degree>
void measure_all(const char* set, const std::vector<Query<Degree>>& queries) {
  measure<Degree>(set, "doubles", queries, collision::first_meeting<Degree>);
  measure<Degree>(set, "doubles, then integers", queries, exact::first_meeting<Degree>);
  measure<Degree>(set, "integers", queries, exact::first_meeting_in_integers<Degree>);
  measure<Degree>(set, "plain solver", queries, plain<Degree>);
}

std::vector<Query<1>> public_queries() {
  std::vector<Query<1>> queries;
  for (const auto& file : test::query_files(test::ccd_data()))
    for (const auto& q : collision::read_queries<1>(test::text_of(file), file.string()))
      queries.push_back({test::features_of(file), q.paths, q.meets});
  return queries;
}

std::vector<Query<3>> cubic_queries(int count) {
  test::QueryMaker<3> maker(11);
  std::vector<Query<3>> queries;
  for (int i = 0; i < count; ++i) {
    const auto q = maker.make(i % 2 == 0 ? Features::vertex_face : Features::edge_edge, i / 2);
    queries.push_back({q.features, q.paths, test::MeetingOracle<3>(q.features, q.paths).truth().meets});
  }
  return queries;
}

}  // namespace
}  // namespace tendril

int main() {
  std::printf("%-10s %-22s %8s %8s %8s %9s %6s %9s\n", "set", "test", "queries", "missed", "invented",
              "undecided", "wide", "us");
  const auto straight = tendril::public_queries();
  if (straight.empty()) std::printf("no public queries at %s\n", tendril::test::ccd_data().c_str());
  if (!straight.empty()) tendril::measure_all<1>("public", straight);
  tendril::measure_all<3>("cubic", tendril::cubic_queries(2000));
}
