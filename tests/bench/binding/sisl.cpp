#include <limits>

#include "bench/binding/peers.h"

#ifdef TENDRIL_BENCH_SISL
#include <sisl.h>

#include <cstdlib>

namespace tendril::bench {
namespace {

constexpr double kResolution = 1e-9;

class Sisl : public Projector {
 public:
  explicit Sisl(const BSpline& curve) {
    std::vector<double> knots(curve.knots().knots().begin(), curve.knots().knots().end()), u;
    for (const Vec3& p : curve.control_points()) u.insert(u.end(), {p.x(), p.y(), p.z()});
    curve_ = newCurve(static_cast<int>(curve.control_points().size()), curve.degree() + 1, knots.data(),
                      u.data(), 1, 3, 1);
  }
  Sisl(const Sisl&) = delete;
  Sisl& operator=(const Sisl&) = delete;
  ~Sisl() override { freeCurve(curve_); }

 protected:
  double distance_at(double t, const Vec3& p) const {
    double point[3];
    int left = 0, status = 0;
    s1221(curve_, 0, t, &left, point, &status);
    return (Vec3(point[0], point[1], point[2]) - p).norm();
  }
  SISLCurve* curve_;
};

class AllAtTheMinimum : public Sisl {
 public:
  using Sisl::Sisl;
  double distance(const Vec3& p) override {
    double point[3] = {p.x(), p.y(), p.z()};
    int points = 0, curves = 0, status = 0;
    double* at = nullptr;
    SISLIntcurve** along = nullptr;
    s1953(curve_, point, 3, kResolution, kResolution, &points, &at, &curves, &along, &status);
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < points; ++i) best = std::min(best, distance_at(at[i], p));
    for (int i = 0; i < curves; ++i) best = std::min(best, distance_at(along[i]->epar1[0], p));
    std::free(at);
    if (along) freeIntcrvlist(along, curves);
    return best;
  }
};

class Fast : public Sisl {
 public:
  using Sisl::Sisl;
  double distance(const Vec3& p) override {
    double point[3] = {p.x(), p.y(), p.z()};
    double at = 0.0, away = 0.0;
    int status = 0;
    s1957(curve_, point, 3, kResolution, kResolution, &at, &away, &status);
    return status < 0 ? std::numeric_limits<double>::infinity() : away;
  }
};

}  // namespace

ProjectionPeer sisl_s1953(const BSpline& curve) {
  return {"SISL s1953", 150, std::make_unique<AllAtTheMinimum>(curve)};
}
ProjectionPeer sisl_s1957(const BSpline& curve) {
  return {"SISL s1957", 6, std::make_unique<Fast>(curve)};
}

}  // namespace tendril::bench

#else
tendril::bench::ProjectionPeer tendril::bench::sisl_s1953(const BSpline&) {
  return {"SISL is not installed: s1953 left out", 150, nullptr};
}
tendril::bench::ProjectionPeer tendril::bench::sisl_s1957(const BSpline&) {
  return {"SISL is not installed: s1957 left out", 6, nullptr};
}
#endif
