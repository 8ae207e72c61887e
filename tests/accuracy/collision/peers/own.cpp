#include <tendril/exact/continuous.h>
#include <tendril/exact/surface.h>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

Said said(const exact::Answer& answer) {
  if (answer.relation == exact::Relation::undecidable) return {};
  return answer.relation != exact::Relation::free;
}

Said said(const collision::FirstMeeting& found) {
  if (found.meeting == collision::Meeting::undecided) return {};
  return found.meeting == collision::Meeting::hit;
}

Said triangles(const Corners& a, const Corners& b) {
  return said(exact::relation(a, b));
}

Said segment(const Corners& a, const Ends& s) {
  return said(exact::relation(exact::triangle(a), exact::segment(s)));
}

double distance(const Corners& a, const Corners& b) {
  return exact::distance(exact::triangle(a), exact::triangle(b)).upper;
}

class Mesh : public MeshPeer {
 public:
  Mesh(Points points, Triangles triangles)
      : surface_(points, {triangles.front().data(), 3 * triangles.size()}) {}
  Said holds(const Vec3& x) override { return said(surface_.inside(x).answer); }
  Said meets(const Vec3& centre, double radius) override {
    return said(surface_.relation(exact::ball(centre, radius)));
  }

 private:
  exact::Surface surface_;
};

}  // namespace

Adapter tendril_adapter() {
  Adapter out{"tendril"};
  out.triangles = triangles;
  out.segment = segment;
  out.distance = distance;
  out.mesh = mesh_of<Mesh>;
  out.holds = out.meets = true;
  out.straight = [](auto features, const auto& paths) {
    return said(exact::first_meeting<1>(features, paths));
  };
  out.cubic = [](auto features, const auto& paths) { return said(exact::first_meeting<3>(features, paths)); };
  return out;
}

Adapter tendril_doubles_adapter() {
  Adapter out{"tendril, doubles alone"};
  out.straight = [](auto features, const auto& paths) {
    return said(collision::first_meeting<1>(features, paths));
  };
  out.cubic = [](auto features, const auto& paths) {
    return said(collision::first_meeting<3>(features, paths));
  };
  return out;
}

}  // namespace tendril::suite
