#pragma once

#include <memory>
#include <vector>

#include "capsule_tree.h"
#include "projector_data.h"

namespace tendril {

/// The search for the nearest points of many points at once.
///
/// Points that lie together are taken together, search::kLanes of them. One way down the tree finds the
/// pieces that may be nearest to any of them; every point is measured against the capsules of these, the
/// piece of the nearest capsule is settled, and then those that the distance found does not exclude: all of
/// this in vector lanes, and by the arithmetic of the search of one point. What lanes do not settle (a piece
/// that must be halved, a tie, pieces too many) goes to that search. The outcome is the same, for it does not
/// depend on the bound a search starts from.
template <int P>
class ProjectionBatch final : public CurveProjector::Data::Batch {
 public:
  /// All must outlive it.
  ProjectionBatch(const CurveProjector::Data& data, const std::vector<search::Piece<P>>& pieces,
                  const CapsuleTree& tree);
  ~ProjectionBatch() override;

  void find(Points points, std::span<const std::uint32_t> which,
            std::span<CurveProjector::Data::Found> found) override;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace tendril
