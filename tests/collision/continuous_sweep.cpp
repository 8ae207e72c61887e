#include <gtest/gtest.h>
#include <tendril/exact/continuous.h>

#include <chrono>
#include <cstdio>
#include <map>

#include "collision/made_queries.h"
#include "support/meeting_truth.h"

// Continuous tests on made-up queries of all kinds against exact truth. TENDRIL_SWEEP_QUERIES is their number
// for each pair of features and each degree.
namespace tendril {
namespace {

using collision::Features;
using collision::FirstMeeting;
using collision::Meeting;
using test::MadeQuery;
using test::MeetingTruth;
using test::Ratio;

struct Tally {
  int queries = 0, meet = 0, missed = 0, invented = 0, wrong_time = 0, wide = 0, in_doubles = 0;
};

template <int Degree>
void judge(const MadeQuery<Degree>& query, const FirstMeeting& found, const MeetingTruth& truth,
           Tally& tally) {
  ++tally.queries;
  tally.meet += truth.meets;
  const bool hit = found.meeting == Meeting::hit;
  tally.missed += truth.meets && !hit;
  tally.invented += !truth.meets && found.meeting != Meeting::free;
  if (hit && truth.meets) {
    tally.wrong_time += Ratio(found.from) > truth.high || Ratio(found.to) < truth.low;
    tally.wide += found.to - found.from > 0x1p-40;
  }
  if (query.surely_meets) EXPECT_TRUE(truth.meets) << query.kind;
}

/// What doubles alone say must be true too.
template <int Degree>
void judge_doubles(const MadeQuery<Degree>& query, const MeetingTruth& truth, Tally& tally) {
  const FirstMeeting found = collision::first_meeting<Degree>(query.features, query.paths);
  tally.in_doubles += found.meeting != Meeting::undecided;
  if (found.meeting == Meeting::free) EXPECT_FALSE(truth.meets) << query.kind;
  if (found.meeting == Meeting::hit) EXPECT_TRUE(truth.meets) << query.kind;
  if (truth.meets) EXPECT_LE(Ratio(found.from), truth.high) << query.kind;
  if (found.meeting == Meeting::hit) EXPECT_GE(Ratio(found.to), truth.low) << query.kind;
}

template <int Degree>
void sweep(Features features) {
  test::QueryMaker<Degree> maker(7 * Degree + (features == Features::edge_edge));
  std::map<std::string, Tally> tallies;
  for (int i = 0; i < TENDRIL_SWEEP_QUERIES; ++i) {
    const MadeQuery<Degree> query = maker.make(features, i);
    const MeetingTruth truth = test::MeetingOracle<Degree>(features, query.paths).truth();
    Tally& tally = tallies[query.kind];
    judge(query, exact::first_meeting<Degree>(features, query.paths), truth, tally);
    judge_doubles(query, truth, tally);
    const FirstMeeting alone = exact::first_meeting_in_integers<Degree>(features, query.paths);
    EXPECT_EQ(alone.meeting == Meeting::hit, truth.meets) << query.kind;
  }
  std::printf("%-20s %8s %8s %8s %8s %8s %8s %10s\n", "kind", "queries", "meet", "missed", "invented", "time",
              "wide", "in doubles");
  for (const auto& [kind, t] : tallies) {
    std::printf("%-20s %8d %8d %8d %8d %8d %8d %10d\n", kind.c_str(), t.queries, t.meet, t.missed, t.invented,
                t.wrong_time, t.wide, t.in_doubles);
    EXPECT_EQ(t.missed + t.invented + t.wrong_time + t.wide, 0) << kind;
    if (TENDRIL_SWEEP_QUERIES >= 2000) EXPECT_GT(t.meet, 0) << kind;
  }
}

TEST(ContinuousSweep, StraightVertexFace) {
  sweep<1>(Features::vertex_face);
}

TEST(ContinuousSweep, StraightEdgeEdge) {
  sweep<1>(Features::edge_edge);
}

TEST(ContinuousSweep, CubicVertexFace) {
  sweep<3>(Features::vertex_face);
}

TEST(ContinuousSweep, CubicEdgeEdge) {
  sweep<3>(Features::edge_edge);
}

}  // namespace
}  // namespace tendril
