#include <tendril/collision/placed_cells.h>

#include <cmath>
#include <limits>

#include "cell_order.h"
#include "patches.h"
#include "slab_table.h"

namespace tendril::collision {
namespace {

// Patches a node keeps: a box is made of each, so more of them cost time, fewer cost tightness where a node
// holds parts of several curve-pairs or both sides of a jump.
constexpr std::size_t kMostPatches = 4;

/// Grows as the root of the number of cells: slabs finer than the cells along the curve gain nothing, and
/// what they cost must not follow the size of the mesh. The numbers weigh what a slab costs against cells
/// entered in vain, by hierarchy_bench; the least is by culling_test.
std::size_t slabs_for(std::size_t cells, std::size_t most) {
  const auto wanted = static_cast<std::size_t>(0.6 * std::sqrt(static_cast<double>(cells)));
  return std::min(std::max<std::size_t>(24, wanted), most);
}

struct alignas(64) Bounded {
  std::uint32_t first, last;  ///< slabs
  AxialRange range;
};

/// Memory that will be wanted soon: a frame comes to most of it once, when it is in no cache. In place: g++
/// drops calls of a function that only fetches.
[[gnu::always_inline]] inline void fetch(const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(at + i);
}

}  // namespace

/// All that a query needs before it comes to a cell.
struct PlacedCells::Lazy {
  Lazy(std::span<const CurvePair> rest, std::size_t cells, const HierarchyOptions& given)
      : slabs(rest, slabs_for(cells, given.most_slabs)), options(given) {
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
  /// The nodes' patches in two rows.
  void pack(std::vector<Kept>& kept) {
    for (std::size_t i = 0; i < of_node.size(); ++i) {
      patches.push_back(of_node[i].front());
      kept[i].more_begin = static_cast<std::uint32_t>(more_patches.size());
      more_patches.insert(more_patches.end(), of_node[i].begin() + 1, of_node[i].end());
      kept[i].more_end = static_cast<std::uint32_t>(more_patches.size());
    }
    of_node = {};
  }

  template <class Visit>
  void each_patch(std::size_t meta, const Kept& of, Visit&& visit) const {
    visit(patches[meta]);
    for (std::size_t i = of.more_begin; i < of.more_end; ++i) visit(more_patches[i]);
  }
  std::uint32_t last_change(std::size_t meta, const Kept& of) const {
    std::uint32_t frame = 0;
    each_patch(meta, of,
               [&](const Bounded& p) { frame = std::max(frame, slabs.last_change(p.first, p.last)); });
    return frame;
  }
  Box box(std::size_t meta, const Kept& of) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Box out{Vec3::Constant(far), Vec3::Constant(-far)};
    each_patch(meta, of, [&](const Bounded& p) { out = join(out, slabs.box(p.first, p.last, p.range)); });
    return out;
  }

  SlabTable slabs;
  HierarchyOptions options;
  std::vector<std::vector<Bounded>> of_node;
  std::vector<Bounded> patches, more_patches;  ///< one of each node, all that most have; the others'
  std::vector<BoundShare> shares;
  std::unique_ptr<PointGroups> groups;
  bool refit_due = false;  ///< the pose before had all of it touched
  HierarchyWork work;
};

PlacedCells::PlacedCells(std::span<const CurvePair> rest, const BoundPoints& points,
                         std::span<const Triangle> triangles, const HierarchyOptions& options) {
  const std::vector<std::uint32_t> order = axial_order(rest, points, triangles);
  CellPoints cells = cell_points(order, triangles, points.size());
  const std::size_t count = cells.begin.size() - 1;
  items_.reserve(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) items_.push_back({order[i], cells.corner[i]});
  lazy_ = std::make_unique<Lazy>(rest, count, options);
  lazy_->of_node.resize(2 * count - 1);
  lazy_->set_patches(root(), cells, points);
  kept_.resize(2 * count - 1);
  lazy_->pack(kept_);
  lazy_->groups = points.group(cells.begin, cells.points);
  // Written now, or the first query that comes to a page would wait for the system to clear it.
  boxes_.assign(2 * root().size() - 1, {Vec3::Zero(), Vec3::Zero()});
  placed_.assign(cells.points.size(), Vec3::Zero());
  for (const std::uint32_t first : cells.begin) cells_.push_back({first});
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
  Kept& kept = kept_[n.meta];
  // A box made in an earlier frame still holds where no slab beneath the node has changed since.
  if (lazy_->refit_due) {
    refit();
  } else if (kept.made == 0 || lazy_->last_change(n.meta, kept) > kept.made) {
    if (!n.cell())
      for (const Node& child : {n.left(), n.right()}) {
        fetch(&kept_[child.meta], sizeof(Kept));
        fetch(&lazy_->patches[child.meta], sizeof(Bounded));
      }
    kept.box = lazy_->box(n.meta, kept);
    ++lazy_->work.boxes;
  }
  kept.made = frame_;
  return kept.box;
}

bool PlacedCells::enter(const Node& n) {
  Cell& cell = cells_[n.begin / kCell];
  HierarchyWork& work = lazy_->work;
  if (cell.touched != frame_) {
    cell.touched = frame_;
    ++work.touched;
  }
  if (cell.placed == frame_) return false;
  place(n);
  if (static_cast<double>(work.placed) > lazy_->options.refit_share * static_cast<double>(work.cells))
    refit();
  return true;
}

void PlacedCells::place(const Node& n) {
  const std::size_t index = n.begin / kCell;
  Cell& cell = cells_[index];
  if (cell.placed == 0 || lazy_->last_change(n.meta, kept_[n.meta]) > cell.placed) {
    const std::size_t begin = n.begin * kLeaf, end = std::min(begin + kCell * kLeaf, items_.size());
    const std::size_t points = cells_[index + 1].first - cell.first;
    fetch(&items_[begin], (end - begin) * sizeof(Item));
    fetch(&placed_[cell.first], points * sizeof(Vec3));
    fetch(&boxes_[n.box], (2 * n.size() - 1) * sizeof(Box));
    lazy_->groups->place(index, MutablePoints(placed_).subspan(cell.first, points));
    fit(n);
    ++lazy_->work.placed;
  }
  cell.placed = frame_;
  kept_[n.meta].made = frame_;
}

/// Exact boxes within a cell.
void PlacedCells::fit(const Node& n) {
  if (!n.leaf()) {
    fit(n.left());
    fit(n.right());
    kept_box(n) = join(boxes_[n.left().box], boxes_[n.right().box]);
    return;
  }
  const Vec3* at = placed_.data() + cells_[n.begin / kCell].first;
  const std::size_t begin = n.begin * kLeaf, end = std::min(begin + kLeaf, items_.size());
  Box all{at[items_[begin].corner[0]], at[items_[begin].corner[0]]};
  for (std::size_t i = begin; i < end; ++i) {
    // Each triangle's first: the processor works at several.
    const auto& [a, b, c] = items_[i].corner;
    all.low = all.low.cwiseMin(at[a].cwiseMin(at[b]).cwiseMin(at[c]));
    all.high = all.high.cwiseMax(at[a].cwiseMax(at[b]).cwiseMax(at[c]));
  }
  kept_box(n) = all;
}

void PlacedCells::refit() {
  if (lazy_->work.refitted) return;
  lazy_->work.refitted = true;
  lazy_->refit_due = false;
  refit(root());
}

void PlacedCells::refit(const Node& n) {
  if (n.cell()) {
    if (cells_[n.begin / kCell].placed != frame_) place(n);
    return;
  }
  refit(n.left());
  refit(n.right());
  kept_[n.meta].box = join(kept_[n.left().meta].box, kept_[n.right().meta].box);
  kept_[n.meta].made = frame_;
}

}  // namespace tendril::collision
