#include "free_bodies.h"

#include <numeric>

namespace tendril {

namespace {

/// Per rod, the number of its body (that of a rod of it), and per body whether something holds it.
struct Grouping {
  explicit Grouping(const Model& model) : body(model.rods.size()), held(model.rods.size(), 0) {
    const std::vector<std::size_t> rod = model.rods_of_nodes();
    std::iota(body.begin(), body.end(), std::size_t{0});
    // The body of a rod is that of its parent's, which comes before it in the order.
    for (const std::size_t r : model.order)
      if (const auto* attached = model.attachment_of(r)) {
        if (attached->reaction)
          body[r] = body[rod[attached->parent]];
        else
          held[r] = 1;
      }
    for (const std::size_t i : model.driven_positions) held[body[rod[i]]] = 1;
    for (const Model::Slider& slider : model.sliders) held[body[rod[slider.node]]] = 1;
  }
  std::vector<std::size_t> body;
  std::vector<char> held;
};

}  // namespace

std::vector<Tree> trees_of(const Model& model) {
  const Grouping grouping(model);
  std::vector<Tree> all(model.rods.size());
  for (std::size_t r = 0; r < all.size(); ++r) {
    Tree& body = all[grouping.body[r]];
    body.free = grouping.held[grouping.body[r]] == 0;
    for (std::size_t i = 0; i < model.rods[r].count; ++i) body.nodes.push_back(model.rods[r].first + i);
  }
  std::erase_if(all, [](const Tree& body) { return body.nodes.empty(); });
  return all;
}

FreeBodies::FreeBodies(const Model& model, const std::vector<std::size_t>& node) {
  const Grouping grouping(model);
  const std::vector<std::size_t> rod = model.rods_of_nodes();
  std::vector<Sum> all(model.rods.size());
  for (std::size_t k = 0; k < node.size(); ++k)
    if (node[k] < model.nodes && !model.holds_position(node[k]))
      all[grouping.body[rod[node[k]]]].pivots.push_back(k);
  for (std::size_t r = 0; r < all.size(); ++r)
    if (grouping.held[r] == 0 && !all[r].pivots.empty()) bodies_.push_back(std::move(all[r]));
}

void FreeBodies::keep(const double* b) {
  for (Sum& body : bodies_) {
    body.sum.setZero();
    for (const std::size_t k : body.pivots)
      for (std::size_t c = 0; c < 3; ++c) body.sum[static_cast<Eigen::Index>(c)] += b[4 * k + c];
  }
}

bool has_free_body(const Model& model) {
  std::vector<std::size_t> nodes(model.nodes);
  std::iota(nodes.begin(), nodes.end(), std::size_t{0});
  return !FreeBodies(model, nodes).empty();
}

}  // namespace tendril
