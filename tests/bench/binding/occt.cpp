#include <limits>

#include "bench/binding/peers.h"

#ifdef TENDRIL_BENCH_OCCT
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Standard_Version.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <algorithm>

namespace tendril::bench {
namespace {

class Occt : public Projector {
 public:
  explicit Occt(const BSpline& curve) {
    const Points u = curve.control_points();
    TColgp_Array1OfPnt poles(1, static_cast<int>(u.size()));
    for (std::size_t i = 0; i < u.size(); ++i)
      poles.SetValue(static_cast<int>(i) + 1, gp_Pnt(u[i].x(), u[i].y(), u[i].z()));
    std::vector<double> knots;
    std::vector<int> times;
    for (const double k : curve.knots().knots()) {
      if (!knots.empty() && knots.back() == k) {
        ++times.back();
        continue;
      }
      knots.push_back(k);
      times.push_back(1);
    }
    const int count = static_cast<int>(knots.size());
    TColStd_Array1OfReal knot(1, count);
    TColStd_Array1OfInteger multiplicity(1, count);
    for (int i = 0; i < count; ++i) {
      knot.SetValue(i + 1, knots[static_cast<std::size_t>(i)]);
      multiplicity.SetValue(i + 1, times[static_cast<std::size_t>(i)]);
    }
    curve_ = new Geom_BSplineCurve(poles, knot, multiplicity, curve.degree());
    start_ = curve_->Value(knots.front());
    end_ = curve_->Value(knots.back());
    projection_.Init(start_, curve_);
  }

  /// An end that is nearest is no extremum to it, so both ends are compared with.
  double distance(const Vec3& p) override {
    const gp_Pnt point(p.x(), p.y(), p.z());
    projection_.Perform(point);
    double best = std::min(point.Distance(start_), point.Distance(end_));
    if (projection_.NbPoints() > 0) best = std::min(best, projection_.LowerDistance());
    return best;
  }

 private:
  Handle(Geom_BSplineCurve) curve_;
  GeomAPI_ProjectPointOnCurve projection_;
  gp_Pnt start_, end_;
};

}  // namespace

ProjectionPeer occt_projector(const BSpline& curve) {
  return {"OCCT " OCC_VERSION_STRING_EXT " GeomAPI_ProjectPointOnCurve", 100, std::make_unique<Occt>(curve)};
}

}  // namespace tendril::bench

#else
tendril::bench::ProjectionPeer tendril::bench::occt_projector(const BSpline&) {
  return {"OCCT is not installed: left out", 100, nullptr};
}
#endif
