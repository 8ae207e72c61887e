#pragma once

#include "draw/camera.h"
#include "draw/picture.h"
#include "draw/shape.h"

#include <tendril/curve/curve_pair.h>

namespace tendril::runner {

/// A polyline as a round tube, or a set of balls.
struct Strand {
  enum class Kind { tube, balls } kind = Kind::tube;
  std::vector<Vec3> points;
  double radius = 0.0;
  Vec3f color = Vec3f::Constant(0.5F);  ///< linear light
  std::vector<double> radii{};          ///< one per point instead of `radius`, when not empty
};

/// What is in a picture: solid things, and strands drawn over them (faded where they lie behind a surface).
struct Drawing {
  const bind::PolygonMesh* mesh = nullptr;
  std::vector<Strand> solid;
  std::vector<Strand> over;
};

/// The primary curve and its masses, and the orientation curve in a second colour.
std::vector<Strand> axis_strands(const CurvePair& pair, Points masses, double radius);

/// Writes a curve-pair's name into a picture, beside the middle of its primary curve.
void name_axis(Picture& picture, const Camera& camera, const CurvePair& pair, const std::string& name);

/// The rod itself, round and as thick as its edges are wide.
/// \param parameters  of the masses on the curve
/// \param widths  per edge; at least 2 `least` is drawn
Strand rod_strand(const CurvePair& pair, std::span<const double> parameters, std::span<const double> widths,
                  double least);

/// Ray-traced without a display: a sun with soft shadow, light from the sky with ambient occlusion, a ground
/// that only catches shadows. Each pixel's samples come from a hash of its place, so the picture is the same
/// for any number of threads.
Picture draw(const Drawing& drawing, const Camera& camera, const scene::ViewOptions& view, int threads);

}  // namespace tendril::runner
