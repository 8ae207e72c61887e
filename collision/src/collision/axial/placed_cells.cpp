#include <tendril/collision/placed_cells.h>

#include <cmath>

#include "cell_order.h"
#include "patches.h"
#include "slab_table.h"

namespace tendril::collision {
namespace {

// Patches a node keeps: a box is made of each, so more of them cost time, fewer cost tightness where a node
// holds parts of several curve-pairs or both sides of a jump.
constexpr std::size_t kMostPatches = 4;

/// Grows as the root of the number of cells: slabs finer than the cells along the curve gain nothing, and
/// what they cost must not follow the size of the mesh.
std::size_t slabs_for(std::size_t cells, std::size_t most) {
  const auto wanted = static_cast<std::size_t>(2.0 * std::sqrt(static_cast<double>(cells)));
  return std::min(std::max<std::size_t>(64, wanted), most);
}

struct Bounded {
  std::uint32_t first, last;  ///< slabs
  AxialRange range;
};

}  // namespace

/// All that a query needs before it comes to a cell.
struct PlacedCells::Lazy {
  Lazy(std::span<const CurvePair> rest, std::size_t cells, const HierarchyOptions& given)
      : slabs(rest, slabs_for(cells, given.most_slabs)),
        options(given),
        patch_begin(2 * cells),
        placed_at(cells, 0),
        touched_at(cells, 0) {
    work.cells = cells;
  }

  using Patches = std::vector<Patch>;

  /// Patches of the nodes, depth first: a parent's are its children's joined.
  Patches set_patches(const Node& n, const CellPoints& cells, const BoundPoints& points) {
    const std::size_t place = n.meta;
    Patches mine;
    if (n.cell()) {
      mine = patches_of(n.begin / kCell, cells, points);
    } else {
      mine = set_patches(n.left(), cells, points);
      const Patches other = set_patches(n.right(), cells, points);
      mine.insert(mine.end(), other.begin(), other.end());
    }
    join_patches(mine, kMostPatches);
    of_node[place].clear();
    for (const Patch& p : mine) of_node[place].push_back({p.first, p.last, range_of(p)});
    return mine;
  }
  Patches patches_of(std::size_t cell, const CellPoints& cells, const BoundPoints& points) {
    Patches out;
    for (std::size_t i = cells.begin[cell]; i < cells.begin[cell + 1]; ++i) {
      points.shares(cells.points[i], shares);
      for (const BoundShare& share : shares) {
        const AxialPoint& at = share.record;
        const std::uint32_t slab = slabs.slab_of(share.pair, at.t);
        out.push_back({share.pair, slab, slab, Vec3(at.u, at.v, std::min(at.w, 0.0)),
                       Vec3(at.u, at.v, std::max(at.w, 0.0))});
      }
    }
    return out;
  }
  /// The nodes' patches in one row.
  void pack() {
    for (std::size_t i = 0; i < of_node.size(); ++i) {
      patch_begin[i] = static_cast<std::uint32_t>(patches.size());
      patches.insert(patches.end(), of_node[i].begin(), of_node[i].end());
    }
    patch_begin[of_node.size()] = static_cast<std::uint32_t>(patches.size());
    of_node = {};
  }

  std::span<const Bounded> patches_at(std::size_t meta) const {
    return std::span(patches).subspan(patch_begin[meta], patch_begin[meta + 1] - patch_begin[meta]);
  }
  std::uint32_t last_change(std::size_t meta) const {
    std::uint32_t frame = 0;
    for (const Bounded& p : patches_at(meta)) frame = std::max(frame, slabs.last_change(p.first, p.last));
    return frame;
  }
  Box box(std::size_t meta) {
    const auto all = patches_at(meta);
    Box out = slabs.box(all[0].first, all[0].last, all[0].range);
    for (const Bounded& p : all.subspan(1)) out = join(out, slabs.box(p.first, p.last, p.range));
    return out;
  }

  SlabTable slabs;
  HierarchyOptions options;
  std::vector<std::vector<Bounded>> of_node;
  std::vector<std::uint32_t> patch_begin;
  std::vector<Bounded> patches;
  std::vector<BoundShare> shares;
  std::unique_ptr<PointGroups> groups;
  std::vector<std::uint32_t> placed_at, touched_at;  ///< frames, of each cell
  bool refit_due = false;                            ///< the pose before had all of it touched
  HierarchyWork work;
};

PlacedCells::PlacedCells(std::span<const CurvePair> rest, const BoundPoints& points,
                         std::span<const Triangle> triangles, const HierarchyOptions& options)
    : order_(axial_order(rest, points, triangles)) {
  CellPoints cells = cell_points(order_, triangles, points.size());
  const std::size_t count = cells.begin.size() - 1;
  lazy_ = std::make_unique<Lazy>(rest, count, options);
  lazy_->of_node.resize(2 * count - 1);
  lazy_->set_patches(root(), cells, points);
  lazy_->pack();
  lazy_->groups = points.group(cells.begin, cells.points);
  boxes_.resize(2 * root().size() - 1);
  made_.assign(2 * count - 1, 0);
  placed_.resize(cells.points.size());
  corner_ = std::move(cells.corner);
  first_ = std::move(cells.begin);
  pose(rest);
}

PlacedCells::PlacedCells(PlacedCells&&) noexcept = default;
PlacedCells& PlacedCells::operator=(PlacedCells&&) noexcept = default;
PlacedCells::~PlacedCells() = default;

void PlacedCells::pose(std::span<const CurvePair> posed) {
  lazy_->slabs.pose(posed, frame_ + 1);
  ++frame_;
  lazy_->groups->pose(posed);
  HierarchyWork& work = lazy_->work;
  // Where the last pose had most of it touched, the next will: to begin with the refit is cheaper than to
  // come to it cell by cell. Half of the share, so that a load about the limit does not go to and fro.
  const auto touched = static_cast<double>(work.touched), cells = static_cast<double>(work.cells);
  lazy_->refit_due = work.refitted && touched > 0.5 * lazy_->options.refit_share * cells;
  work = {0, 0, 0, work.cells, 0, 0, false};
}

HierarchyWork PlacedCells::work() const {
  HierarchyWork out = lazy_->work;
  out.slabs = lazy_->slabs.made();
  out.unframed = lazy_->slabs.unframed();
  return out;
}

const Box& PlacedCells::make(const Node& n) {
  // A box made in an earlier frame still holds where no slab beneath the node has changed since.
  if (lazy_->refit_due) {
    refit();
  } else if (made_[n.meta] == 0 || lazy_->last_change(n.meta) > made_[n.meta]) {
    boxes_[n.box] = lazy_->box(n.meta);
    ++lazy_->work.boxes;
  }
  made_[n.meta] = frame_;
  return boxes_[n.box];
}

bool PlacedCells::enter(const Node& n) {
  const std::size_t cell = n.begin / kCell;
  HierarchyWork& work = lazy_->work;
  if (lazy_->touched_at[cell] != frame_) {
    lazy_->touched_at[cell] = frame_;
    ++work.touched;
  }
  if (lazy_->placed_at[cell] == frame_) return false;
  place(n);
  if (static_cast<double>(work.placed) > lazy_->options.refit_share * static_cast<double>(work.cells))
    refit();
  return true;
}

void PlacedCells::place(const Node& n) {
  const std::size_t cell = n.begin / kCell;
  std::uint32_t& at = lazy_->placed_at[cell];
  if (at == 0 || lazy_->last_change(n.meta) > at) {
    lazy_->groups->place(cell, MutablePoints(placed_).subspan(first_[cell], first_[cell + 1] - first_[cell]));
    fit(n);
    ++lazy_->work.placed;
  }
  at = frame_;
  made_[n.meta] = frame_;
}

/// Exact boxes within a cell.
void PlacedCells::fit(const Node& n) {
  if (!n.leaf()) {
    fit(n.left());
    fit(n.right());
    boxes_[n.box] = join(boxes_[n.left().box], boxes_[n.right().box]);
    return;
  }
  const Vec3* at = placed_.data() + first_[n.begin / kCell];
  const std::size_t begin = n.begin * kLeaf, end = std::min(begin + kLeaf, order_.size());
  Vec3 low = at[corner_[begin][0]], high = low;
  for (std::size_t i = begin; i < end; ++i)
    for (const std::uint8_t corner : corner_[i]) {
      low = low.cwiseMin(at[corner]);
      high = high.cwiseMax(at[corner]);
    }
  boxes_[n.box] = {low, high};
}

void PlacedCells::refit() {
  if (lazy_->work.refitted) return;
  lazy_->work.refitted = true;
  lazy_->refit_due = false;
  refit(root());
}

void PlacedCells::refit(const Node& n) {
  if (n.cell()) {
    if (lazy_->placed_at[n.begin / kCell] != frame_) place(n);
    return;
  }
  refit(n.left());
  refit(n.right());
  boxes_[n.box] = join(boxes_[n.left().box], boxes_[n.right().box]);
  made_[n.meta] = frame_;
}

}  // namespace tendril::collision
