#pragma once

#include <memory>
#include <vector>

#include "curve/distance/capsule_tree.h"
#include "curve/distance/projector_data.h"

namespace tendril {

/// The search for the nearest points of many points at once.
///
/// Points that lie together are taken together, search::kLanes of them. One descent of the tree finds the
/// pieces that may be nearest to any of them; every point is measured against the capsules of these, the
/// piece of the nearest capsule is resolved, and then those that the distance found does not exclude: all of
/// this in vector lanes, and by the arithmetic of the search of one point. What lanes do not resolve (a piece
/// that must be halved, a tie, pieces too many) goes to that search. The outcome is the same, for it does not
/// depend on the bound a search starts from.
///
/// All that is handed over must outlive it.
template <int P>
std::unique_ptr<CurveProjector::Data::Batch> make_batch(const CurveProjector::Data& data,
                                                        const std::vector<search::Piece<P>>& pieces,
                                                        const CapsuleTree& tree);

}  // namespace tendril
