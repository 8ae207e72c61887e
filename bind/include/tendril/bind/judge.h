#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/binding.h>

#include <array>

/// Tells a tear from a stretch by refinement: the mesh is bound and posed, split at the middles of its edges,
/// bound and posed again. Across a tear two neighbours are bound apart, however near they are: their stretch
/// doubles with every split, and so does the number of such edges, which lie along a curve. A steep but
/// continuous map keeps its stretch, and the number of edges in a steep region grows fourfold, as its area
/// holds more of them.
namespace tendril::bind {

/// How finely a mesh is examined.
struct JudgeOptions {
  int refinements = 2;  ///< 1 to 4
  /// Meshes with fewer edges are split before they are judged, so that a share of 1e-4 of the edges is some.
  std::size_t least_edges = 100000;
  double limit = 20.0;              ///< stretch from which an edge counts in JudgeLevel::beyond
  double most_growth = 1.1;         ///< of any quantile with one split, for the verdict `smooth`
  double most_growth_of_max = 1.6;  ///< of the largest stretch with one split, for the verdict `smooth`
  std::size_t worst = 100;          ///< edges listed
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

/// Whether stretches stay bounded under refinement.
enum class TearVerdict {
  smooth,  ///< no growth beyond the options' limits
  tear     ///< some quantile, or the largest stretch, grows beyond them
};

/// An edge among the most stretched ones.
struct WorstEdge {
  std::uint32_t a;  ///< point of TearJudge::mesh(), whose first points are those of the mesh given
  std::uint32_t b;  ///< its other point
  double stretch;   ///< posed over rest length
};

/// What the judge says of a pose.
struct JudgeReport {
  std::vector<JudgeLevel> levels;                    ///< the coarsest first
  std::array<double, kJudgeShares.size()> growth{};  ///< of the quantiles, largest over the splits
  double growth_of_max = 0.0;                        ///< of the largest stretch, largest over the splits
  /// log2 of the growth of `beyond` with the last split: 1 along a line, 2 over an area; 0 for none.
  double exponent = 0.0;
  TearVerdict verdict = TearVerdict::smooth;  ///< by the growths
  std::vector<WorstEdge> worst;               ///< of the first level, the worst first
};

/// Binds all levels once, judges any number of poses.
class TENDRIL_BIND_API TearJudge {
 public:
  /// Throws InvalidInput as Binding does. Memory: 4^refinements times the mesh and its binding.
  TearJudge(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& bind,
            const JudgeOptions& options = {});
  ~TearJudge();
  TearJudge(const TearJudge&) = delete;
  TearJudge& operator=(const TearJudge&) = delete;

  /// \param posed  as for Binding::update
  JudgeReport judge(std::span<const CurvePair> posed) const;

  /// The first level: the mesh in triangles, with its own points first.
  const PolygonMesh& mesh() const;
  const Binding& binding() const;  ///< of the first level

 private:
  struct Level;
  void conclude(JudgeReport& report) const;
  std::vector<CurvePair> rest_;
  JudgeOptions options_;
  int threads_;
  std::vector<Level> levels_;
};

/// Every triangle split in four at the middles of its edges; faces become fans of triangles first. Points
/// keep their ids.
TENDRIL_BIND_API PolygonMesh split_at_middles(const PolygonMesh& mesh);

}  // namespace tendril::bind
