#include "ply_plan.h"

namespace tendril::bind::ply {
namespace {

/// Several exporters have names of their own for s and t.
constexpr std::array<std::array<std::string_view, 2>, 3> texture_names{
    {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};

/// The first pair of names that a vertex has both of.
void plan_texture(const PlyElement& element, Plan& plan) {
  const auto find = [&](std::string_view name) {
    const auto is_it = [&](const PlyProperty& p) { return p.name == name && !p.count_type; };
    return std::find_if(element.properties.begin(), element.properties.end(), is_it) -
           element.properties.begin();
  };
  const auto count = static_cast<std::ptrdiff_t>(element.properties.size());
  for (const auto& [s, t] : texture_names) {
    if (plan.texture() || find(s) == count || find(t) == count) continue;
    plan.slots[static_cast<std::size_t>(find(s))] = tex_s;
    plan.slots[static_cast<std::size_t>(find(t))] = tex_t;
    plan.has[tex_s] = plan.has[tex_t] = true;
  }
}

}  // namespace

Slot slot_of(const PlyProperty& property, bool face) {
  if (property.count_type) {
    const bool index_list = property.name == "vertex_indices" || property.name == "vertex_index";
    if (face && property.name == "texcoord") return texcoord;
    return face && index_list ? indices : unused;
  }
  const auto* const name = std::find(slot_names.begin(), slot_names.end(), property.name);
  const auto slot = static_cast<Slot>(name - slot_names.begin());
  return slot > alpha || (face && slot < red) ? unused : slot;
}

Plan make_plan(const PlyElement& element, bool face) {
  Plan plan;
  for (const PlyProperty& property : element.properties) {
    const Slot slot = slot_of(property, face);
    plan.slots.push_back(slot);
    plan.has_indices |= slot == indices;
    if (slot < slot_count) plan.has[slot] = true;
  }
  for (Slot& slot : plan.slots) {  // a part of a normal or color is of no use
    if ((slot >= red && slot <= alpha && !plan.colors()) || (slot >= nx && slot <= nz && !plan.normals()))
      slot = unused;
  }
  if (!face) plan_texture(element, plan);
  return plan;
}

}  // namespace tendril::bind::ply
