#pragma once

#include "rig/sections.h"

namespace tendril::runner {

/// An end of a curve that is joined to nothing.
struct CurveEnd {
  std::size_t curve;
  bool last;  ///< its last node; else its first
};

/// How a body stands.
struct Stance {
  Vec3 up = Vec3::UnitY();          ///< unit
  std::vector<CurveEnd> feet;       ///< ends that point down and whose skin is near the lowest
  std::vector<CurveEnd> on_ground;  ///< ends whose skin is, whichever way they point
  CurveEnd lowest{};                ///< whose skin is the lowest
  double height = 0.0;              ///< of the mesh along `up`
  double ground = 0.0;              ///< coordinate of its lowest point along `up`
};

/// How the body stands where `up` is up. A foot's skin comes within 5 % of the height to the lowest point,
/// and the limb, seen from 30 to 50 % of the height back, goes down by more than 30 degrees; or within 15 %,
/// and its last two edges do.
Stance stand(const bind::PolygonMesh& mesh, const std::vector<RigCurve>& curves, const Body& body,
             const Vec3& up);

/// The direction among x, y, z and their opposites in which the most feet are below and it does not fall
/// over: that its centre of mass is above what it rests on counts as four feet, y as two and a half, z as
/// two, since most meshes have one of these up.
Stance guess_stance(const bind::PolygonMesh& mesh, const std::vector<RigCurve>& curves, const Body& body);

/// Such a direction as options name it: "y", "-z".
std::string direction_name(const Vec3& up);

}  // namespace tendril::runner
