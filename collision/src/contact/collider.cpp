#include <tendril/base/error.h>
#include <tendril/contact/collider.h>

#include <string>

namespace tendril::contact {

void check(const Collider& collider, std::size_t i, double thickest) {
  const std::string place = "contact.colliders[" + std::to_string(i) + "]";
  if (!collider.shape) throw InvalidInput(place + ".shape", "none", "a shape");
  if (collider.body && collider.driven)
    throw InvalidInput(place + ".driven", "given", "none for a free body");
  const Placement& at = collider.placement;
  if (!is_finite(at.position) || !at.rotation.allFinite() ||
      !((at.rotation * at.rotation.transpose() - Mat3::Identity()).norm() < 1e-9))
    throw InvalidInput(place + ".placement", "no finite place and rotation", "a rotation matrix");
  if (!(collider.shape->bore() > thickest))
    throw InvalidInput(place + ".shape", "a hollow of radius " + std::to_string(collider.shape->bore()),
                       "more than a rod's radius and the range, " + std::to_string(thickest));
}

}  // namespace tendril::contact
