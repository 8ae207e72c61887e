#include "sketch.h"

#include <algorithm>
#include <cmath>

#include "study/svg.h"

namespace tendril::gallery {
namespace {

constexpr double kMargin = 12, kTitle = 26;

/// A colour "#rrggbb" made lighter or darker.
std::string shaded(const std::string& colour, double light) {
  std::string out = "#";
  for (std::size_t i = 1; i + 1 < 7; i += 2) {
    const int value = std::stoi(colour.substr(i, 2), nullptr, 16);
    char two[8];
    std::snprintf(two, sizeof two, "%02x", static_cast<int>(std::clamp(light * value, 0.0, 255.0)));
    out += two;
  }
  return out;
}

}  // namespace

struct Sketch::Frame {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
  double scale = 1.0, height = 0.0;
  double x(const Vec3& c) const { return kMargin + scale * (c.x() - low.x()); }
  double y(const Vec3& c) const { return kTitle + kMargin + scale * (high.y() - c.y()); }
  std::string path(const std::vector<Vec3>& corners) const {
    std::string out;
    for (const Vec3& c : corners)
      out += (out.empty() ? "M" : "L") + svg::number("%.1f ", x(c)) + svg::number("%.1f", y(c));
    return out;
  }
};

std::string Sketch::drawn(const Item& item, const Frame& frame) {
  const Vec3& at = item.corners[0];
  const std::string path = frame.path(item.corners);
  switch (item.kind) {
    case Item::Kind::face:
      return "<path class=\"" + std::string(item.opacity < 1.0 ? "ghost" : "face") + "\" d=\"" + path +
             "Z\" fill=\"" + item.colour + "\"/>\n";
    case Item::Kind::line:
      return svg::Element("path")
          .with("d", path)
          .with("stroke", item.colour)
          .with("stroke-width", item.size)
          .with("stroke-linecap", "round")
          .end();
    case Item::Kind::dot:
      return svg::circle(frame.x(at), frame.y(at), item.size, item.colour);
    case Item::Kind::words:
      return svg::words(frame.x(at), frame.y(at), "middle", item.text);
  }
  return "";
}

View seen_from(const Vec3& from, const Vec3& up) {
  const Vec3 right = up.cross(from).normalized();
  return {right, from.cross(right).normalized()};
}

Vec3 Sketch::project(const Vec3& point) const {
  return {view_.right.dot(point), view_.up.dot(point), view_.right.cross(view_.up).dot(point)};
}

void Sketch::add(Item item) {
  double depth = 0.0;
  for (const Vec3& c : item.corners) depth += c.z();
  item.depth = depth / static_cast<double>(item.corners.size());
  items_.push_back(std::move(item));
}

void Sketch::faces(const bind::PolygonMesh& mesh, Points points, const std::string& colour, double opacity) {
  const Vec3 light = Vec3(-0.35, 0.55, 0.75).normalized();
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    Item item{Item::Kind::face, {}, "", "", 0.0, 0.0, opacity};
    for (const std::uint32_t corner : mesh.face(f)) item.corners.push_back(project(points[corner]));
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < item.corners.size(); ++k)
      normal += (item.corners[k] - item.corners[0]).cross(item.corners[k + 1] - item.corners[0]);
    const double size = normal.norm();
    const double facing = size > 0.0 ? std::abs(normal.dot(light)) / size : 0.0;
    item.colour = shaded(colour, 0.5 + 0.6 * facing);
    add(std::move(item));
  }
}

void Sketch::line(Points points, const std::string& colour, double width) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) edge(points[i], points[i + 1], colour, width);
}

void Sketch::edge(const Vec3& a, const Vec3& b, const std::string& colour, double width) {
  add({Item::Kind::line, {project(a), project(b)}, colour, "", width, 0.0});
}

void Sketch::dot(const Vec3& point, const std::string& colour, double radius) {
  add({Item::Kind::dot, {project(point)}, colour, "", radius, 0.0});
}

void Sketch::words(const Vec3& point, const std::string& text) {
  add({Item::Kind::words, {project(point)}, "", text, 0.0, 0.0});
}

std::string Sketch::svg(double width, const std::string& title) const {
  Frame frame;
  for (const Item& item : items_)
    for (const Vec3& c : item.corners) {
      frame.low = frame.low.cwiseMin(c);
      frame.high = frame.high.cwiseMax(c);
    }
  const double wide = std::max(frame.high.x() - frame.low.x(), 1e-9);
  frame.scale = (width - 2 * kMargin) / wide;
  frame.height = kTitle + 2 * kMargin + frame.scale * (frame.high.y() - frame.low.y());
  std::vector<const Item*> sorted;
  for (const Item& item : items_) sorted.push_back(&item);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Item* a, const Item* b) { return a->depth < b->depth; });
  std::string body = svg::words(kMargin, 18, "start", title, "title");
  for (const Item* item : sorted) body += drawn(*item, frame);
  return svg::picture(
      width, frame.height,
      ".words{font-size:11px}.title{font-size:13px;font-weight:bold}.face{stroke:#333;stroke-width:.15}"
      ".ghost{opacity:.45;stroke:#333;stroke-width:.15}",
      body);
}

}  // namespace tendril::gallery
