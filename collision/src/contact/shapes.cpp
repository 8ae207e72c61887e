#include <tendril/base/error.h>
#include <tendril/contact/shape.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace tendril::contact {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double positive_or_infinite(double value, const char* what) {
  if (!(value > 0.0)) throw InvalidInput(what, std::to_string(value), "a positive length");
  return value;
}
double positive(double value, const char* what) {
  return positive_or_infinite(value < kInfinite ? value : 0.0, what);
}

/// Of a line or a circle, each at most `apart` long; at most 10^4.
int parts_of(double length, double apart) {
  return static_cast<int>(std::min(1e4, std::ceil(length / apart)));
}

/// The distance of a feature (a point, a line, a face) from which x stands `away`: the part of space across
/// the feature and the normal bends by 1 / distance.
/// \param along  projects on the feature's own directions
SignedDistance from_feature(const Vec3& away, const Mat3& along) {
  const double d = away.norm();
  const Vec3 n = away / d;
  return {d, n, (Mat3::Identity() - n * n.transpose() - along) / d};
}

class HalfSpace final : public Shape {
 public:
  SignedDistance at(const Vec3& x) const override { return {x.z(), Vec3::UnitZ(), Mat3::Zero()}; }
  double distance(const Vec3& x) const override { return x.z(); }
  double outward_radius() const override { return kInfinite; }
  double extent() const override { return kInfinite; }
};

/// What lies within a radius of a line: phi is the distance from the line less the radius, bent as about a
/// line beside it and as about a point beyond its ends. A ball where half is 0.
class Capsule final : public Shape {
 public:
  Capsule(double half, double radius) : half_(half), radius_(radius) {}

  SignedDistance at(const Vec3& x) const override {
    const Vec3 away = from_axis(x);
    const bool beside = std::abs(x.z()) < half_;
    if (away.squaredNorm() == 0.0) return {-radius_, Vec3::UnitX(), Mat3::Zero()};
    const Mat3 along = beside ? Mat3(Vec3::UnitZ() * Vec3::UnitZ().transpose()) : Mat3(Mat3::Zero());
    SignedDistance result = from_feature(away, along);
    result.value -= radius_;
    return result;
  }
  double distance(const Vec3& x) const override { return from_axis(x).norm() - radius_; }
  double outward_radius() const override { return radius_; }
  double extent() const override { return half_ + radius_; }
  bool round() const override { return true; }
  std::vector<ShapePoint> points(double depth) const override {
    const int parts = parts_of(2.0 * half_, std::sqrt(8.0 * radius_ * depth));
    std::vector<ShapePoint> result;
    for (int i = 0; i <= parts; ++i)
      result.push_back({Vec3(0, 0, parts > 0 ? half_ * (2.0 * i / parts - 1.0) : 0.0), radius_});
    return result;
  }

 private:
  Vec3 from_axis(const Vec3& x) const { return {x.x(), x.y(), x.z() - std::clamp(x.z(), -half_, half_)}; }

  double half_, radius_;
};

/// Outside, the nearest point is that of clamping: a coordinate that needed none runs along the feature met
/// (a face has two such, an edge one, a corner none), and phi does not bend that way. Inside, the nearest
/// face decides; phi has kinks between two of them, where either's side serves.
class Box final : public Shape {
 public:
  explicit Box(Vec3 half) : half_(std::move(half)) {}

  SignedDistance at(const Vec3& x) const override {
    Vec3 away = x - x.cwiseMax(-half_).cwiseMin(half_);
    if (away.squaredNorm() == 0.0) return within(x);
    Mat3 along = Mat3::Zero();
    for (Eigen::Index c = 0; c < 3; ++c)
      if (away[c] == 0.0) along(c, c) = 1.0;
    return from_feature(away, along);
  }
  double distance(const Vec3& x) const override {
    const Vec3 beyond = x.cwiseAbs() - half_;
    return beyond.maxCoeff() > 0.0 ? beyond.cwiseMax(0.0).norm() : beyond.maxCoeff();
  }
  double outward_radius() const override { return 0.0; }
  double extent() const override { return half_.norm(); }
  std::vector<ShapePoint> points(double) const override {
    std::vector<ShapePoint> result;
    for (int i = 0; i < 8; ++i)
      result.push_back({half_.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)), 0.0});
    return result;
  }

 private:
  SignedDistance within(const Vec3& x) const {
    Eigen::Index face = 0;
    const double value = (x.cwiseAbs() - half_).maxCoeff(&face);
    Vec3 n = Vec3::Zero();
    n[face] = x[face] < 0.0 ? -1.0 : 1.0;
    return {value, n, Mat3::Zero()};
  }

  Vec3 half_;
};

/// What a rectangle [inner, outer] x [-half, half] of the half plane (distance from the axis, z) sweeps
/// about the z axis: a cylinder where inner is -infinity, so that no point is nearer to that side.
class Revolved final : public Shape {
 public:
  Revolved(double inner, double outer, double half) : inner_(inner), outer_(outer), half_(half) {}

  SignedDistance at(const Vec3& x) const override {
    const double rho = std::hypot(x.x(), x.y());
    const Vec3 radial = rho > 0.0 ? Vec3(x.x() / rho, x.y() / rho, 0.0) : Vec3::UnitX();
    const Vec3 around(-radial.y(), radial.x(), 0.0);
    const auto [value, by_rho, by_z, bend] = meridian(rho, x.z());
    const Vec3 normal = by_rho * radial + by_z * Vec3::UnitZ();
    const Vec3 across = by_z * radial - by_rho * Vec3::UnitZ();
    // The meridian's own bend, and what turning it about the axis adds: the gradient's radial part over rho.
    const double turned = rho > 0.0 ? by_rho / rho : 0.0;
    return {value, normal, bend * across * across.transpose() + turned * around * around.transpose()};
  }
  double distance(const Vec3& x) const override { return meridian(std::hypot(x.x(), x.y()), x.z()).value; }
  /// Rims are as sharp as edges; without them what is left bends about the axis, or, of a bore, inward.
  double outward_radius() const override {
    const bool edges = half_ < kInfinite;
    return edges ? 0.0 : outer_;
  }
  double extent() const override { return std::hypot(outer_, half_); }
  /// On both rims, of which a half space touches any point first; chords between them are `depth` short.
  std::vector<ShapePoint> points(double depth) const override {
    std::vector<ShapePoint> result;
    if (!(half_ < kInfinite && outer_ < kInfinite)) return result;
    const int parts = std::max(8, parts_of(2.0 * std::numbers::pi * outer_, std::sqrt(8.0 * outer_ * depth)));
    for (const double z : {-half_, half_})
      for (int i = 0; i < parts; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / parts;
        result.push_back({Vec3(outer_ * std::cos(angle), outer_ * std::sin(angle), z), 0.0});
      }
    return result;
  }
  double bore() const override { return inner_ > 0.0 ? inner_ : kInfinite; }

 private:
  /// The same problem in the half plane: the distance of a rectangle, flat beside its sides and round about
  /// its corners, which are the rims.
  struct Meridian {
    double value, by_rho, by_z, bend;
  };

  Meridian meridian(double rho, double z) const {
    const double side = rho > outer_ ? rho - outer_ : rho < inner_ ? rho - inner_ : 0.0;
    const double above = z - std::clamp(z, -half_, half_);
    if (side == 0.0 && above == 0.0) return within(rho, z);
    const double d = std::hypot(side, above);
    return {d, side / d, above / d, side != 0.0 && above != 0.0 ? 1.0 / d : 0.0};
  }
  Meridian within(double rho, double z) const {
    const double out = rho - outer_, in = inner_ - rho, end = std::abs(z) - half_;
    if (end >= std::max(out, in)) return {end, 0.0, z < 0.0 ? -1.0 : 1.0, 0.0};
    return out >= in ? Meridian{out, 1.0, 0.0, 0.0} : Meridian{in, -1.0, 0.0, 0.0};
  }

  double inner_, outer_, half_;
};

}  // namespace

ShapePtr half_space() {
  return std::make_shared<HalfSpace>();
}

ShapePtr ball(double radius) {
  return std::make_shared<Capsule>(0.0, positive(radius, "ball.radius"));
}

ShapePtr capsule(double half, double radius) {
  if (half != 0.0) positive(half, "capsule.half");
  return std::make_shared<Capsule>(half, positive(radius, "capsule.radius"));
}

ShapePtr box(const Vec3& half) {
  for (const double h : half) positive(h, "box.half");
  return std::make_shared<Box>(half);
}

ShapePtr cylinder(double radius, double half) {
  return std::make_shared<Revolved>(-kInfinite, positive(radius, "cylinder.radius"),
                                    positive_or_infinite(half, "cylinder.half"));
}

ShapePtr tube(double inner, double outer, double half) {
  positive(inner, "tube.inner");
  if (!(outer > inner)) throw InvalidInput("tube.outer", std::to_string(outer), "more than the inner radius");
  return std::make_shared<Revolved>(inner, outer, positive_or_infinite(half, "tube.half"));
}

}  // namespace tendril::contact
