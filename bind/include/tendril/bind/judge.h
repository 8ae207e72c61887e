#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/binding.h>

#include <array>

/// Tells a tear from a stretch by its limit. Where the map from rest to pose is continuous, however steep,
/// the ends of a piece of an edge come together as the piece is halved again and again; where it jumps they
/// stay apart. The edges that are halved are those that are stretched the most, and those of which a half is
/// stretched clearly more than the whole: across a jump twice as much.
namespace tendril::bind {

/// How finely a mesh is examined.
struct JudgeOptions {
  int refinements = 1;              ///< times all edges are split, 1 to 4
  std::size_t least_edges = 10000;  ///< meshes with fewer are split before they are judged
  double limit = 20.0;              ///< stretch from which an edge counts in JudgeLevel::beyond
  double least_gap = 1e-3;          ///< of a tear, over the diagonal of the mesh's box; in [1e-6, 1]
  std::size_t halved = 500;         ///< edges of either kind that are halved to the limit
  std::size_t worst = 100;          ///< edges and tears listed
};

/// Shares of the edges of which the stretch is given: half of them are stretched less than quantile[0].
inline constexpr std::array<double, 5> kJudgeShares{0.5, 0.9, 0.99, 0.999, 0.9999};

/// Edges by their posed over their rest length; edges of no length are left out.
struct JudgeLevel {
  std::size_t points = 0;                              ///< of the mesh at this level
  std::size_t edges = 0;                               ///< of the mesh at this level
  std::size_t faces = 0;                               ///< triangles
  std::array<double, kJudgeShares.size()> quantile{};  ///< stretch, by kJudgeShares
  double max = 0.0;                                    ///< largest stretch
  std::size_t beyond = 0;                              ///< edges stretched more than the limit
  std::size_t flipped = 0;    ///< triangles turned over against their axis' frame: folds
  double rest_error = 0.0;    ///< [length]
  std::size_t ambiguous = 0;  ///< points in BindReport::ambiguous
};

/// Whether the pose is continuous.
enum class TearVerdict {
  smooth,  ///< no piece of an edge stays apart
  tear     ///< some do
};

/// An edge among the most stretched ones.
struct WorstEdge {
  std::uint32_t a;  ///< point of TearJudge::mesh(), whose first points are those of the mesh given
  std::uint32_t b;  ///< its other point
  double stretch;   ///< posed over rest length
};

/// Where an edge is torn.
struct Tear {
  Vec3 place;  ///< on the mesh at rest [length]
  double gap;  ///< by which what is side by side there is apart in the pose [length]
};

/// What the judge says of a pose.
struct JudgeReport {
  TearVerdict verdict = TearVerdict::smooth;  ///< by `torn`
  std::size_t torn = 0;                       ///< of the edges that were halved
  std::vector<Tear> tears;                    ///< of these the widest, as many as asked for
  double steepest = 0.0;           ///< largest stretch of the others' shortest pieces: that of the limit
  std::vector<WorstEdge> worst;    ///< of the first level, the worst first
  std::vector<JudgeLevel> levels;  ///< the coarsest first
  /// Of the quantiles, largest over the splits. A tear doubles the stretch of what crosses it, a transition
  /// that the mesh does not resolve may do so too.
  std::array<double, kJudgeShares.size()> growth{};
  double growth_of_max = 0.0;  ///< of the largest stretch, largest over the splits
  /// log2 of the growth of `beyond` with the last split: 1 along a line, 2 over an area; 0 for none.
  double exponent = 0.0;
};

/// What a judge takes before it is asked for one.
struct JudgeCost {
  std::size_t points;  ///< that are bound
  std::size_t edges;   ///< of the finest level
};
/// Counts without binding; O(corners log corners). Throws InvalidInput as TearJudge does for its options.
TENDRIL_BIND_API JudgeCost judge_cost(const PolygonMesh& mesh, const JudgeOptions& options = {});

/// Binds all levels once, judges any number of poses.
class TENDRIL_BIND_API TearJudge {
 public:
  /// Throws InvalidInput as Binding does. Memory: about 700 bytes for each of judge_cost's points.
  TearJudge(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& bind,
            const JudgeOptions& options = {});
  ~TearJudge();
  TearJudge(const TearJudge&) = delete;
  TearJudge& operator=(const TearJudge&) = delete;

  /// \param posed  as for Binding::update
  JudgeReport judge(std::span<const CurvePair> posed) const;

  const Binding& own_binding() const;  ///< of the mesh's own points
  /// The first level: the mesh in triangles, with its own points first.
  const PolygonMesh& mesh() const;
  const Binding& binding() const;  ///< of the first level

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/// Every triangle split in four at the middles of its edges; faces become fans of triangles first. Points
/// keep their ids.
TENDRIL_BIND_API PolygonMesh split_at_middles(const PolygonMesh& mesh);

}  // namespace tendril::bind
