#include <tendril/exact/continuous.h>
#include <tendril/exact/distance.h>
#include <tendril/exact/surface.h>

#include <cmath>
#include <limits>

#include "accuracy/collision/suite.h"
#include "collision/made_meshes.h"
#include "collision/minkowski.h"
#include "support/random.h"

// Numbers that wish no good: NaN, infinities, denormals, the largest there are, coinciding and nearly equal
// ones.
namespace tendril::suite {
namespace {

using collision::Features;
using collision::FirstMeeting;
using collision::Meeting;
using exact::Answer;
using exact::Reason;
using exact::Relation;
using exact::Shape;
using test::Random;
using Limits = std::numeric_limits<double>;

double poison(Random& random) {
  const double values[] = {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()};
  return values[random.integer(3)];
}

/// At the ends of the range of doubles.
double wild(Random& random) {
  const double values[] = {
      Limits::denorm_min(), -Limits::min(), Limits::max(), -Limits::max(), 0x1p-1000, 0x1p900, 1.0, 0.0};
  return values[random.integer(8)];
}

double nasty(Random& random) {
  const double values[] = {0.0, -0.0, 1.0, -1.0, 1e-12, std::nextafter(1.0, 2.0), 0.1, 0.5};
  const int choice = random.integer(12);
  if (choice < 8) return values[choice];
  return std::ldexp(random.uniform(-1, 1), random.integer(2) * (random.integer(60) - 30));
}

/// One query in 50 is of wild numbers, which cost most of the time.
Vec3 nasty_point(long number, Random& random) {
  Vec3 out;
  for (double& x : out) x = number % 50 == 0 ? wild(random) : nasty(random);
  return out;
}

Shape nasty_shape(long number, Random& random) {
  Shape out{static_cast<exact::Kind>(random.integer(5)), {}};
  for (Vec3& x : out.points) x = nasty_point(number, random);
  if (random.integer(4) == 0) out.points[1] = out.points[0];
  if (out.kind == exact::Kind::ball || out.kind == exact::Kind::capsule)
    out.radius = std::abs(number % 50 == 0 ? wild(random) : nasty(random));
  return out;
}

std::size_t used(const Shape& s) {
  return s.kind == exact::Kind::triangle                                    ? 3
         : s.kind == exact::Kind::segment || s.kind == exact::Kind::capsule ? 2
                                                                            : 1;
}

/// Two shapes, poisoned now and then: the right status, the same answer either way round, and now and then
/// the true one.
void judge_shapes(long number, Random& random, Row& row) {
  Shape a = nasty_shape(number, random), b = nasty_shape(number, random);
  const bool poisoned = number % 9 == 0;
  if (poisoned)
    a.points[static_cast<std::size_t>(random.integer(static_cast<int>(used(a))))].y() = poison(random);
  const Answer answer = exact::relation(a, b);
  const exact::Distance d = exact::distance(a, b);
  row.positive += answer.relation == Relation::hit || answer.relation == Relation::touching;
  const bool sound = poisoned ? answer == collision::undecidable(Reason::not_finite)
                              : answer.relation != Relation::undecidable && answer.reason == Reason::none;
  const bool bounded = poisoned || (d.lower >= 0.0 && d.lower <= d.upper);
  row.wrong += !sound || !bounded || answer != exact::relation(b, a) || d.answer != answer;
  if (poisoned || number % 64 != 0 || a.radius != 0.0 || b.radius != 0.0) return;
  const Relation truth =
      test::minkowski_relation(Points(a.points).first(used(a)), Points(b.points).first(used(b)));
  row.missed += truth != Relation::free && answer.relation == Relation::free;
  row.invented += truth == Relation::free && answer.relation != Relation::free;
  row.wrong += truth != Relation::free && answer.relation != Relation::free && truth != answer.relation;
}

template <int Degree>
void judge_moving(long number, Random& random, Row& row) {
  collision::Paths<Degree> paths;
  for (auto& path : paths)
    for (Vec3& p : path) p = nasty_point(number, random);
  if (number % 5 == 0) paths[random.integer(4)] = paths[random.integer(4)];
  const bool poisoned = number % 9 == 0;
  if (poisoned) paths[random.integer(4)][random.integer(Degree + 1)][random.integer(3)] = poison(random);
  const Features features = random.integer(2) == 0 ? Features::vertex_face : Features::edge_edge;
  const FirstMeeting quick = collision::first_meeting<Degree>(features, paths);
  const FirstMeeting found = exact::first_meeting<Degree>(features, paths);
  row.positive += found.meeting == Meeting::hit;
  const bool sound = (found.meeting == Meeting::undecided) == poisoned &&
                     found.reason == (poisoned ? Reason::not_finite : Reason::none) && found.from >= 0.0 &&
                     found.from <= found.to && found.to <= 1.0 &&
                     (found.meeting != Meeting::hit || found.to - found.from <= 0x1p-40);
  const bool agree = quick.meeting == Meeting::undecided || quick.meeting == found.meeting;
  row.wrong += !sound || !agree;
}

void judge_surface(const exact::Surface& surface, long number, Random& random, Row& row) {
  Vec3 x = nasty_point(number, random);
  const bool poisoned = number % 9 == 0;
  if (poisoned) x[random.integer(3)] = poison(random);
  const double most = x.cwiseAbs().maxCoeff();
  const Answer truth = poisoned     ? collision::undecidable(Reason::not_finite)
                       : most < 1.0 ? collision::kHit
                       : most > 1.0 ? collision::kFree
                                    : collision::kTouching;
  const Answer answer = surface.inside(x).answer;
  row.positive += truth.relation == Relation::hit || truth.relation == Relation::touching;
  row.wrong += answer != truth || surface.nearest(exact::point(x)).distance.answer.relation !=
                                      (poisoned                               ? Relation::undecidable
                                       : truth.relation == Relation::touching ? Relation::touching
                                                                              : Relation::free);
}

template <class Judge>
void run(const char* family, const Settings& settings, const Judge& judge, std::vector<Row>& rows) {
  Row row{"hostile", family, "tendril"};
  Random random(settings.seed);
  const double seconds = bench::fastest(1, [&] {
    for (long i = 0; i < settings.count; ++i) judge(i, random, row);
  });
  row.queries = settings.count;
  row.us = 1e6 * seconds / static_cast<double>(settings.count);
  rows.push_back(row);
}

}  // namespace

void hostile_section(const Settings& settings, std::vector<Row>& rows) {
  run("two shapes", settings, judge_shapes, rows);
  run("straight paths", settings, judge_moving<1>, rows);
  run("cubic paths", settings, judge_moving<3>, rows);
  const test::MadeMesh cube = test::cube(2);
  const exact::Surface surface(cube.points, cube.corners);
  run(
      "points and a cube", settings,
      [&](long number, Random& random, Row& row) { judge_surface(surface, number, random, row); }, rows);
}

}  // namespace tendril::suite
