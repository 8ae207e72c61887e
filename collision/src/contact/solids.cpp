#include "solids.h"

#include <tendril/base/error.h>

#include <algorithm>

namespace tendril::contact {

Solids::Solids(std::vector<Collider> colliders, double thickest) : all(std::move(colliders)) {
  if (all.empty()) throw InvalidInput("contact.colliders", "none", "at least one");
  for (std::size_t i = 0; i < all.size(); ++i) {
    contact::check(all[i], i, thickest);
    driven = driven || all[i].driven;
    if (all[i].body) bodies.push_back(*all[i].body);
  }
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
}

std::vector<Placement> Solids::place(const StateView& state) const {
  std::vector<Placement> result;
  result.reserve(all.size());
  for (const Collider& collider : all) result.push_back(collider.at(state));
  return result;
}

std::vector<double> Solids::breaks() const {
  std::vector<double> result;
  for (const Collider& collider : all)
    result.insert(result.end(), collider.breaks.begin(), collider.breaks.end());
  std::sort(result.begin(), result.end());
  return result;
}

void Solids::check_bodies(std::size_t count) const {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].body && *all[i].body >= count)
      throw InvalidInput("contact.colliders[" + std::to_string(i) + "].body", std::to_string(*all[i].body),
                         "below the number of free bodies, " + std::to_string(count));
}

std::string Solids::named(std::size_t i) const {
  return "collider " + std::to_string(i) + (all[i].name.empty() ? "" : " (" + all[i].name + ")");
}

}  // namespace tendril::contact
