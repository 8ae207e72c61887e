// Times and errors of pairs of triangles, beside those of the peers, from one run on one thread; the
// arguments are those of command_line.h.
#include <tendril/exact/shape.h>

#include "bench/clock.h"
#include "bench/collision/peers.h"
#include "bench/command_line.h"
#include "collision/minkowski.h"

namespace tendril::bench {

namespace {

using Pairs = std::vector<test::TrianglePair>;

struct Method {
  std::string name;
  void (*meet)(std::span<const test::TrianglePair>, std::span<char>);
};

void tendril_meet(std::span<const test::TrianglePair> pairs, std::span<char> out) {
  for (std::size_t i = 0; i < pairs.size(); ++i)
    out[i] = exact::relation(pairs[i].a, pairs[i].b).relation != exact::Relation::free ? 1 : 0;
}

std::vector<Method> methods() {
  return {
      {"tendril", tendril_meet},
      {"CGAL", cgal_meet},
#ifdef TENDRIL_BENCH_FCL
      {"FCL", fcl_meet},
#endif
  };
}

bool proper(const std::array<Vec3, 3>& t) {
  const Points points(t);
  const int unit = test::unit_exponent(points);
  const auto d = test::differences(points.first(1), points.subspan(1), unit);
  return !zero(cross(d[0], d[1]));
}

/// The peers ask for triangles that are no lines.
Pairs proper_pairs(const test::PairFamily& family, std::size_t count) {
  test::Random random(7);
  Pairs pairs;
  while (pairs.size() < count) {
    const test::TrianglePair p = family.next(random);
    if (proper(p.a) && proper(p.b)) pairs.push_back(p);
  }
  return pairs;
}

std::vector<char> truth_of(const Pairs& pairs) {
  std::vector<char> truth;
  for (const auto& p : pairs)
    truth.push_back(test::minkowski_relation(p.a, p.b) != collision::Relation::free ? 1 : 0);
  return truth;
}

struct Errors {
  int missed = 0, invented = 0;
};
Errors errors_of(const std::vector<char>& answers, const std::vector<char>& truth) {
  Errors e;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    e.missed += truth[i] > answers[i];
    e.invented += truth[i] < answers[i];
  }
  return e;
}

OrderedJson measure(const test::PairFamily& family, Settings& settings, Table& table) {
  const Pairs pairs = proper_pairs(family, settings.quick ? 2000 : 20000);
  const std::vector<char> truth = truth_of(pairs);
  const auto meeting = std::count(truth.begin(), truth.end(), 1);
  std::vector<std::string> row{family.name, std::to_string(pairs.size()), std::to_string(meeting)};
  OrderedJson out{{"pairs", pairs.size()}, {"meeting", meeting}};
  for (const Method& method : methods()) {
    std::vector<char> answers(pairs.size());
    const double seconds = fastest(settings.quick ? 3 : 9, [&] { method.meet(pairs, answers); });
    const double us = 1e6 * seconds / static_cast<double>(pairs.size());
    const Errors e = errors_of(answers, truth);
    row.push_back(text("%.3f", us));
    row.push_back(std::to_string(e.missed) + " / " + std::to_string(e.invented));
    out[method.name] = {{"us", us}, {"false_negatives", e.missed}, {"false_positives", e.invented}};
    if (method.name == "tendril" && e.missed + e.invented > 0)
      settings.broken.push_back("triangle pairs: " + family.name);
  }
  table.row(row);
  return out;
}

OrderedJson triangles_section(Settings& settings) {
  heading("triangle pairs",
          "us a pair, and pairs missed / invented, against exact arithmetic; touching is meeting");
  std::vector<std::string> headings{"family", "pairs", "meeting"};
  for (const Method& method : methods()) {
    headings.push_back(method.name + " us");
    headings.push_back("FN / FP");
  }
  Table table(headings);
  OrderedJson out;
  for (const test::PairFamily& family : test::pair_families())
    if (family.name != "degenerate" && family.name != "extreme")
      out[family.name] = measure(family, settings, table);
  table.print();
  return out;
}

}  // namespace

}  // namespace tendril::bench

int main(int argc, char** argv) {
  using namespace tendril::bench;
  return run_bench(argc, argv, false, {}, {{"triangles", "triangles", triangles_section}});
}
