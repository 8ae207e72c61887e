#include "player/page.h"

#include "draw/solid.h"
#include "player/pack.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tendril::runner {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPointUnit = 0x1p-25;  // of coordinates, over the size
constexpr double kParts = 0x1p24;       // of a curve's domain, and of weights
constexpr double kArrowUnit = 0x1p-20;  // of contacts, over the size
constexpr double kLongestArrow = 0.12;  // of their forces
constexpr double kControlRange = 0x1p28;

std::int32_t rounded(double value) {
  return static_cast<std::int32_t>(std::llround(value));
}

Json json_of(const Vec3& v) {
  // Nine digits are all that single precision holds.
  const auto digits = [](double x) { return std::round(x * 1e9) * 1e-9; };
  return {digits(v.x()), digits(v.y()), digits(v.z())};
}

/// Where the page's coordinates are zero, and their unit.
struct Place {
  Vec3 middle = Vec3::Zero();
  double size = 1.0;

  explicit Place(const Film& film) {
    std::vector<Vec3> all = film.mesh().points;
    if (all.empty())
      for (const Rod& rod : film.file().scene.rods) all.insert(all.end(), rod.p.begin(), rod.p.end());
    Vec3 low = all.front(), high = low;
    for (const Vec3& p : all) low = low.cwiseMin(p), high = high.cwiseMax(p);
    middle = 0.5 * (low + high);
    if ((high - low).norm() > 0.0) size = (high - low).norm();
  }
  Vec3 operator()(const Vec3& p) const { return (p - middle) / size; }
};

class Writer {
 public:
  Writer(const Film& film, const Camera& camera) : film_(film), camera_(camera), place_(film) {}

  void write() {
    add_pairs();
    add_controls();
    add_mesh();
    add_binding();
    add_solids();
    add_times();
    add_contacts();
    add_view();
    json_["sections"] = pack_.sections();
  }
  Json& json() { return json_; }
  std::string data() const { return pack_.text(); }

 private:
  void add_pairs() {
    for (std::size_t k = 0; k < film_.rest_of_all().size(); ++k) {
      const KnotVector& knots = film_.rest_of_all()[k].knots();
      const auto nodes = film_.parameters(k);
      std::vector<double> width;
      for (std::size_t i = 0; i < nodes.size(); ++i) width.push_back(width_at(k, i) / place_.size);
      json_["pairs"].push_back({{"name", film_.file().names[k]},
                                {"degree", knots.degree()},
                                {"knots", std::vector<double>(knots.knots().begin(), knots.knots().end())},
                                {"domain", {knots.start(), knots.end()}},
                                {"nodes", std::vector<double>(nodes.begin(), nodes.end())},
                                {"width", width}});
    }
    json_["bound"] = film_.mesh().points.empty() ? std::vector<std::size_t>{} : film_.file().bound_to;
  }

  double width_at(std::size_t pair, std::size_t node) const {
    const std::vector<double>& width = film_.file().scene.rods[pair].width;
    if (width.empty()) return film_.file().thickness[pair];
    return 0.5 * (width[node > 0 ? node - 1 : 0] + width[std::min(node, width.size() - 1)]);
  }

  /// Seven numbers a control point, at rest and at each moment: the primary curve's, the way from there to
  /// the orientation curve's, the turn.
  void add_controls() {
    std::vector<double> values;
    append_controls(film_.rest_of_all(), values);
    const std::size_t stride = values.size();
    for (const Moment& m : film_.moments()) append_controls(m.pairs, values);
    std::array<double, 3> units{};
    const auto kind = [](std::size_t i) { return i % 7 < 3 ? std::size_t{0} : i % 7 < 6 ? 1 : 2; };
    for (std::size_t i = 0; i < values.size(); ++i)
      units[kind(i)] = std::max(units[kind(i)], std::abs(values[i]) / kControlRange);
    for (double& unit : units) unit = std::max(unit, 1e-300);
    std::vector<std::int32_t> steps;
    for (std::size_t i = 0; i < values.size(); ++i) steps.push_back(rounded(values[i] / units[kind(i)]));
    pack_.add("control", steps, stride, 2);
    json_["controlUnits"] = units;
  }

  void append_controls(const std::vector<CurvePair>& pairs, std::vector<double>& to) const {
    for (const CurvePair& pair : pairs) {
      const Points p = pair.primary().control_points(), q = pair.orientation().control_points();
      for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 at = place_(p[i]), side = (q[i] - p[i]) / place_.size;
        to.insert(to.end(), {at.x(), at.y(), at.z(), side.x(), side.y(), side.z(),
                             pair.turn().empty() ? 0.0 : pair.turn()[i]});
      }
    }
  }

  static std::vector<std::int32_t> steps_of(Points points, double unit) {
    std::vector<std::int32_t> out;
    for (const Vec3& p : points)
      for (int k = 0; k < 3; ++k) out.push_back(rounded(p[k] / unit));
    return out;
  }

  static std::vector<std::int32_t> corners_of(const bind::PolygonMesh& mesh,
                                              std::vector<std::size_t>* faces) {
    std::vector<std::int32_t> out;
    for (const auto& triangle : bind::fan_triangles(mesh, faces))
      for (const std::uint32_t corner : triangle) out.push_back(static_cast<std::int32_t>(corner));
    return out;
  }

  static std::int32_t packed(const bind::Color& c) { return c[0] | c[1] << 8 | c[2] << 16; }

  void add_mesh() {
    const bind::PolygonMesh& mesh = film_.mesh();
    std::vector<Vec3> points;
    for (const Vec3& p : mesh.points) points.push_back(place_(p));
    pack_.add("points", steps_of(points, kPointUnit), 3);
    std::vector<std::size_t> face_of;
    pack_.add("triangles", corners_of(mesh, &face_of));
    std::vector<std::int32_t> colors;
    for (const bind::Color& c : mesh.point_colors) colors.push_back(packed(c));
    const bool of_faces = colors.empty() && !mesh.face_colors.empty();
    if (of_faces)
      for (const std::size_t f : face_of) colors.push_back(packed(mesh.face_colors[f]));
    pack_.add("colors", colors);
    json_["colorsOfFaces"] = of_faces;
    json_["pointUnit"] = kPointUnit;
    json_["parts"] = kParts;
  }

  /// Of each point the nearest place, with what is left of the weight, and the others, which are few.
  void add_binding() {
    std::vector<std::int32_t> pair, t, count, other, weight, place_pair, place_t;
    std::map<std::pair<std::uint32_t, double>, std::int32_t> places;
    const auto part = [&](const bind::Share& share) {
      const KnotVector& knots = film_.rest()[share.pair].knots();
      return rounded(kParts * (share.record.t - knots.start()) / (knots.end() - knots.start()));
    };
    for (std::size_t i = 0; i < film_.mesh().points.size(); ++i) {
      const std::vector<bind::Share> shares = film_.binding().shares(i);
      pair.push_back(static_cast<std::int32_t>(shares[0].pair));
      t.push_back(part(shares[0]));
      count.push_back(static_cast<std::int32_t>(shares.size() - 1));
      for (const bind::Share& share : std::span(shares).subspan(1)) {
        const auto [known, fresh] =
            places.try_emplace({share.pair, share.record.t}, static_cast<std::int32_t>(places.size()));
        if (fresh) {
          place_pair.push_back(static_cast<std::int32_t>(share.pair));
          place_t.push_back(part(share));
        }
        other.push_back(known->second);
        weight.push_back(rounded(kParts * share.weight));
      }
    }
    pack_.add("near_pair", pair);
    pack_.add("near_t", t);
    pack_.add("other_count", count);
    pack_.add("other_place", other);
    pack_.add("other_weight", weight, 1, 0);
    pack_.add("place_pair", place_pair);
    pack_.add("place_t", place_t);
    json_["still"] = Json::array();
    if (!film_.mesh().points.empty())
      for (const std::size_t i : film_.still()) json_["still"].push_back(i);
  }

  /// Solids in their own frames, and where these are.
  void add_solids() {
    bind::PolygonMesh all;
    json_["solids"] = Json::array();
    std::vector<std::int32_t> triangles;
    for (std::size_t k = 0; k < film_.file().bodies.size(); ++k) {
      const scene::SolidShape& shape = film_.file().bodies[k].shape;
      const scene::SolidPose& pose = film_.moments().front().bodies[k];
      const std::size_t from = triangles.size();
      bind::PolygonMesh one;
      add_solid(shape, {}, pose.rotation.transpose() * (camera_.centre - pose.position), camera_.size, one);
      for (const std::int32_t corner : corners_of(one, nullptr))
        triangles.push_back(corner + static_cast<std::int32_t>(all.points.size()));
      all.points.insert(all.points.end(), one.points.begin(), one.points.end());
      json_["solids"].push_back({{"name", film_.file().bodies[k].name},
                                 {"from", from},
                                 {"to", triangles.size()},
                                 {"color", packed(one.point_colors.front())},
                                 {"flat", shape.type == scene::SolidShape::Type::half_space}});
    }
    double far = 0.0;
    for (const Vec3& p : all.points) far = std::max(far, p.cwiseAbs().maxCoeff());
    const double unit = std::max(far / kControlRange, 1e-300);
    pack_.add("solid_points", steps_of(all.points, unit), 3);
    json_["solidUnit"] = unit / place_.size;
    pack_.add("solid_triangles", triangles);
    for (const Moment& m : film_.moments()) {
      Json poses = Json::array();
      for (const scene::SolidPose& pose : m.bodies) {
        const Eigen::Quaterniond q(pose.rotation);
        poses.push_back({{"p", json_of(place_(pose.position))}, {"q", {q.x(), q.y(), q.z(), q.w()}}});
      }
      json_["poses"].push_back(poses);
    }
  }

  void add_times() {
    for (const Moment& m : film_.moments()) {
      json_["times"].push_back(m.time);
      json_["energies"]["kinetic"].push_back(m.energies.kinetic);
      json_["energies"]["elastic"].push_back(m.energies.elastic);
      json_["energies"]["potential"].push_back(m.energies.potential);
      json_["energies"]["total"].push_back(m.energies.total());
    }
    const double duration = film_.moments().back().time - film_.moments().front().time;
    json_["pace"] = film_.pace();
    json_["digits"] =
        std::clamp(2 - static_cast<int>(std::floor(std::log10(std::max(duration, 1e-6)))), 0, 8);
    const auto unit = film_.file().units.find("time");
    json_["timeUnit"] = unit != film_.file().units.end() ? unit->second : "";
    add_steps();
  }

  /// Of many steps, the least and the largest of each of some hundred parts of the time.
  void add_steps() {
    constexpr std::size_t kDrawn = 800;
    const std::vector<Step>& steps = film_.steps();
    Json at = Json::array(), size = Json::array();
    const std::size_t each = steps.size() > kDrawn ? 2 * ((steps.size() + kDrawn - 1) / kDrawn) : 1;
    const auto less = [](const Step& a, const Step& b) { return a.size < b.size; };
    for (std::size_t i = 0; i < steps.size(); i += each) {
      const auto first = steps.begin() + static_cast<std::ptrdiff_t>(i);
      const auto last = steps.begin() + static_cast<std::ptrdiff_t>(std::min(i + each, steps.size()));
      const auto [low, high] = std::minmax_element(first, last, less);
      std::vector<Step> drawn{*low};
      if (high != low) drawn.insert(high < low ? drawn.begin() : drawn.end(), *high);
      for (const Step& step : drawn) {
        at.push_back(step.end);
        size.push_back(step.size);
      }
    }
    json_["steps"] = {{"at", at}, {"step", size}};
  }

  void add_contacts() {
    double most = 0.0;
    for (const Moment& m : film_.moments())
      for (const Meeting& meeting : m.meetings) most = std::max(most, meeting.force.norm());
    const double scale = most > 0.0 ? kLongestArrow / most : 0.0;
    std::vector<std::int32_t> count;
    std::vector<Vec3> ends;
    for (const Moment& m : film_.moments()) {
      count.push_back(static_cast<std::int32_t>(m.meetings.size()));
      for (const Meeting& meeting : m.meetings) {
        const Vec3 at = place_(meeting.point);
        ends.insert(ends.end(), {at, Vec3(at + scale * meeting.force)});
      }
    }
    pack_.add("contact_count", count);
    pack_.add("contact_ends", steps_of(ends, kArrowUnit), 6);
    json_["arrowUnit"] = kArrowUnit;
  }

  /// Height of what shadows fall on: the ground of pictures, or a half space that is above it.
  double ground() const {
    const Vec3& up = camera_.ground_up;
    double out = camera_.ground;
    for (std::size_t k = 0; k < film_.file().bodies.size(); ++k) {
      const scene::SolidPose& pose = film_.moments().front().bodies[k];
      const bool level = pose.rotation.col(2).dot(up) > 0.999;
      if (level && film_.file().bodies[k].shape.type == scene::SolidShape::Type::half_space)
        out = std::max(out, pose.position.dot(up));
    }
    return (out - up.dot(place_.middle)) / place_.size;
  }

  void add_view() {
    const Camera& c = camera_;
    json_["view"] = {{"eye", json_of(place_(c.eye))},
                     {"target", json_of(place_(c.eye + c.forward * c.forward.dot(c.centre - c.eye)))},
                     {"up", json_of(c.ground_up)},
                     {"ground", ground()},
                     {"lamp", json_of(1.2 * c.ground_up - 0.5 * c.right - 0.55 * c.forward)}};
  }

  const Film& film_;
  const Camera& camera_;
  Place place_;
  Pack pack_;
  Json json_;
};

/// Not to end the element that it stands in.
std::string in_page(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.replace(at, 2, "<\\/");
  return text;
}

}  // namespace

void require_player() {}

std::string player_page(const Film& film, const Camera& camera, const std::string& name,
                        const std::string& about) {
  Writer writer(film, camera);
  writer.write();
  writer.json()["name"] = name;
  writer.json()["about"] = about;
  const std::string json = writer.json().dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out = page_template();
  const std::pair<std::string, std::string> parts[] = {{"@FILM@", in_page(json)}, {"@DATA@", writer.data()}};
  for (const auto& [mark, text] : parts) out.replace(out.find(mark), mark.size(), text);
  return out;
}

}  // namespace tendril::runner
