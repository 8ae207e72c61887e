#include <tendril/exact/distance.h>

#include <cmath>

#include "accuracy/collision/suite.h"
#include "collision/minkowski.h"
#include "collision/triangle_pairs.h"

// Two triangles, a triangle and a segment, and distances, against their Minkowski differences in whole
// numbers.
namespace tendril::suite {
namespace {

using collision::Relation;
using test::PairFamily;
using test::Ratio;
using test::TrianglePair;
using test::Whole;

std::vector<TrianglePair> pairs_of(const PairFamily& family, const Settings& settings) {
  test::Random random(settings.seed);
  std::vector<TrianglePair> out;
  for (long i = 0; i < settings.count; ++i) out.push_back(family.next(random));
  return out;
}

bool proper(const Corners& t) {
  const Points points(t);
  const auto d = test::differences(points.first(1), points.subspan(1), test::unit_exponent(points));
  return !zero(cross(d[0], d[1]));
}

/// Only tendril is asked about numbers at the ends of the range of doubles: others may not even return.
bool fits(const Adapter& adapter, const PairFamily& family) {
  return family.name != "extreme" || adapter.name == "tendril";
}

std::vector<char> all(std::size_t count) {
  return std::vector<char>(count, 1);
}

std::vector<char> meeting(const std::vector<Relation>& truth) {
  std::vector<char> out;
  for (const Relation r : truth) out.push_back(r != Relation::free);
  return out;
}

/// \return relations that are not the true ones, either way round
long wrong_relations(const std::vector<Relation>& truth, const std::function<exact::Shape(std::size_t)>& a,
                     const std::function<exact::Shape(std::size_t)>& b) {
  long wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    wrong +=
        exact::relation(a(i), b(i)).relation != truth[i] || exact::relation(b(i), a(i)).relation != truth[i];
  return wrong;
}

/// What is asked with the first triangle: a triangle or a segment, as a span of points.
template <class Other>
struct Pairing {
  Corners first;
  Other other;
};

template <class Other, class Ask>
void judge_pairs(const char* section, const PairFamily& family, const std::vector<Pairing<Other>>& queries,
                 const Ask& ask_of, const std::function<exact::Shape(const Other&)>& shape_of,
                 std::vector<Row>& rows) {
  std::vector<Relation> truth;
  std::vector<char> good;
  for (const auto& [first, other] : queries) {
    truth.push_back(test::minkowski_relation(first, other));
    if constexpr (std::is_same_v<Other, Ends>)
      good.push_back(proper(first) && other[0] != other[1]);
    else
      good.push_back(proper(first) && proper(other));
  }
  for (const Adapter& adapter : adapters()) {
    const auto ask = ask_of(adapter);
    if (!ask || !fits(adapter, family)) continue;
    Row row = judge({section, family.name, adapter.name}, queries, meeting(truth),
                    adapter.proper ? good : all(queries.size()),
                    [&](const Pairing<Other>& q) { return ask(q.first, q.other); });
    if (row.own())
      row.wrong = wrong_relations(
          truth, [&](std::size_t i) { return exact::triangle(queries[i].first); },
          [&](std::size_t i) { return shape_of(queries[i].other); });
    rows.push_back(row);
  }
}

Ratio ratio(double x) {
  const Vec3 v(x, 0, 0);
  const int e = test::unit_exponent(Points(&v, 1));
  const Whole m = test::in_units(x, e);
  return e >= 0 ? Ratio(Whole(m << e)) : Ratio(m, Whole(1) << -e);
}

Ratio true_square(const TrianglePair& p) {
  const int e = test::common_exponent(p.a, p.b);
  const Ratio square = test::minkowski_square(p.a, p.b, e);
  const Whole power = Whole(1) << 2 * std::abs(e);
  return e >= 0 ? square * Ratio(power) : square / Ratio(power);
}

/// The largest difference of coordinates; 0 of pairs that are all one point.
double size_of(const TrianglePair& p) {
  Vec3 low = p.a[0], high = p.a[0];
  for (const auto* t : {&p.a, &p.b})
    for (const Vec3& x : *t) low = low.cwiseMin(x), high = high.cwiseMax(x);
  return (high - low).maxCoeff();
}

bool bounds_hold(const TrianglePair& p, const Ratio& square) {
  const exact::Distance d = exact::distance(exact::triangle(p.a), exact::triangle(p.b));
  if (square == 0) return d.answer.relation != Relation::free && d.lower == 0.0 && d.upper == 0.0;
  const Ratio low = ratio(d.lower), high = ratio(d.upper);
  return d.answer.relation == Relation::free && low * low <= square && square <= high * high &&
         d.upper - d.lower <= 0x1p-40 * d.upper;
}

constexpr double kOff = 1e-9;  ///< of the size: farther off is wrong

void count_distance(double said, double truth, double size, Row& row) {
  const double off = said == truth ? 0.0 : std::abs(said - truth) / size;
  if (!(off <= kOff)) {
    if (truth == 0.0)
      ++row.missed;
    else if (said == 0.0)
      ++row.invented;
    else
      ++row.wrong;
  }
  row.error = std::max(row.error.value_or(0.0), off);
}

Row judge_distances(const Adapter& adapter, const PairFamily& family, const std::vector<TrianglePair>& pairs,
                    const std::vector<Ratio>& squares) {
  Row row{"distance", family.name, adapter.name};
  std::vector<double> said(pairs.size(), -1.0);
  std::vector<char> fit(pairs.size(), 1);
  if (adapter.proper)
    for (std::size_t i = 0; i < pairs.size(); ++i) fit[i] = proper(pairs[i].a) && proper(pairs[i].b);
  const long asked = std::count(fit.begin(), fit.end(), 1);
  const double seconds = bench::fastest(pairs.size() < 20000 ? 5 : 1, [&] {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (fit[i]) said[i] = adapter.distance(pairs[i].a, pairs[i].b);
  });
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    row.positive += squares[i] == 0;
    const bool answered = fit[i] && !std::isnan(said[i]);
    row.undecided += !answered;
    if (!answered) continue;
    count_distance(said[i], std::sqrt(squares[i].convert_to<double>()), size_of(pairs[i]), row);
    if (row.own()) row.wrong += !bounds_hold(pairs[i], squares[i]);
  }
  row.queries = static_cast<long>(pairs.size());
  row.us = 1e6 * seconds / static_cast<double>(std::max(1L, asked));
  return row;
}

}  // namespace

void triangles_section(const Settings& settings, std::vector<Row>& rows) {
  for (const PairFamily& family : test::pair_families()) {
    std::vector<Pairing<Corners>> queries;
    for (const TrianglePair& p : pairs_of(family, settings)) queries.push_back({p.a, p.b});
    judge_pairs<Corners>(
        "triangles", family, queries, [](const Adapter& a) { return a.triangles; },
        [](const Corners& t) { return exact::triangle(t); }, rows);
  }
}

void segments_section(const Settings& settings, std::vector<Row>& rows) {
  for (const PairFamily& family : test::pair_families()) {
    std::vector<Pairing<Ends>> queries;
    for (const TrianglePair& p : pairs_of(family, settings)) queries.push_back({p.a, {p.b[0], p.b[1]}});
    judge_pairs<Ends>(
        "segments", family, queries, [](const Adapter& a) { return a.segment; },
        [](const Ends& s) { return exact::segment(s); }, rows);
  }
}

void distance_section(const Settings& settings, std::vector<Row>& rows) {
  for (const PairFamily& family : test::pair_families()) {
    if (family.name == "extreme") continue;  // squares beyond doubles
    const std::vector<TrianglePair> pairs = pairs_of(family, settings);
    std::vector<Ratio> squares;
    for (const TrianglePair& p : pairs) squares.push_back(true_square(p));
    for (const Adapter& adapter : adapters())
      if (adapter.distance) rows.push_back(judge_distances(adapter, family, pairs, squares));
  }
}

}  // namespace tendril::suite
