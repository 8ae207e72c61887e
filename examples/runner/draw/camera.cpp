#include "draw/camera.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace tendril::runner {
namespace {

constexpr double kHalfAngle = 16.0;  // degrees, of the longer side
constexpr double kMargin = 0.88;     // part of the picture that is used
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

}  // namespace

CameraFit::CameraFit(const scene::ViewOptions& view) : ground_up_(view.up.stableNormalized()) {
  // At yaw 0 the world's x (or y, when x is up) points to the right.
  const Vec3 side = std::abs(ground_up_.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 level = (side - side.dot(ground_up_) * ground_up_).normalized();
  const Vec3 front = level.cross(ground_up_);
  const Vec3 away = std::cos(radians(view.yaw)) * front + std::sin(radians(view.yaw)) * level;
  forward_ = -(std::cos(radians(view.pitch)) * away + std::sin(radians(view.pitch)) * ground_up_);
  right_ = forward_.cross(ground_up_).normalized();
  up_ = right_.cross(forward_);
  const double longer = std::max(view.width, view.height);
  tan_x_ = std::tan(radians(kHalfAngle)) * view.width / longer;
  tan_y_ = std::tan(radians(kHalfAngle)) * view.height / longer;
  reach_.fill(-kInfinity);
  low_.setConstant(kInfinity);
  high_.setConstant(-kInfinity);
  ground_ = kInfinity;
}

std::optional<std::array<double, 2>> Camera::place(const Vec3& p) const {
  const Vec3 way = p - eye;
  const double depth = way.dot(forward);
  if (!(depth > 0.0)) return std::nullopt;
  return std::array{way.dot(right) / (depth * tan_x), way.dot(up) / (depth * tan_y)};
}

Vec3 up_direction(const std::string& name) {
  static const std::map<std::string, Vec3> axes{{"x", Vec3::UnitX()},   {"y", Vec3::UnitY()},
                                                {"z", Vec3::UnitZ()},   {"-x", -Vec3::UnitX()},
                                                {"-y", -Vec3::UnitY()}, {"-z", -Vec3::UnitZ()}};
  const auto found = axes.find(name);
  if (found == axes.end()) throw InvalidInput("--up", "'" + name + "'", "x, y, z, -x, -y or -z");
  return found->second;
}

void CameraFit::include(Points points) {
  for (const Vec3& p : points) {
    const double x = p.dot(right_) / (kMargin * tan_x_), y = p.dot(up_) / (kMargin * tan_y_),
                 z = p.dot(forward_);
    const std::array<double, 4> reach{x - z, -x - z, y - z, -y - z};
    for (std::size_t k = 0; k < 4; ++k) reach_[k] = std::max(reach_[k], reach[k]);
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
    ground_ = std::min(ground_, p.dot(ground_up_));
  }
}

Camera CameraFit::camera() const {
  if (!(ground_ < kInfinity)) {
    return {-5.0 * forward_, right_, up_, forward_, tan_x_, tan_y_, ground_up_, 0.0, Vec3::Zero(), 1.0};
  }
  const double diagonal = (high_ - low_).stableNorm();
  // Beyond this the squares and differences that pictures are made of leave the finite numbers.
  constexpr double kLargest = 1e100;
  if (!(std::max({diagonal, low_.cwiseAbs().maxCoeff(), high_.cwiseAbs().maxCoeff()}) <= kLargest))
    throw InvalidInput("picture", "points beyond 1e100", "smaller coordinates");
  const double size = diagonal > 0.0 ? diagonal : 1.0;
  // The sides of the picture give x_e = tan_x (reach_right - reach_left) / 2 for the eye, and the distance.
  const double back = std::max({0.5 * (reach_[0] + reach_[1]), 0.5 * (reach_[2] + reach_[3])});
  const Vec3 centre = 0.5 * (low_ + high_);
  const double depth = std::max(back, 0.5 * size - centre.dot(forward_));
  const double x = 0.5 * kMargin * tan_x_ * (reach_[0] - reach_[1]);
  const double y = 0.5 * kMargin * tan_y_ * (reach_[2] - reach_[3]);
  const Vec3 eye = x * right_ + y * up_ - depth * forward_;
  return {eye, right_, up_, forward_, tan_x_, tan_y_, ground_up_, ground_, centre, size};
}

}  // namespace tendril::runner
