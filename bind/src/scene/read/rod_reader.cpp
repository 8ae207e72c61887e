#include "scene/read/rod_reader.h"

#include "scene/read/curve_reader.h"

#include <algorithm>
#include <cmath>

namespace tendril::scene {
namespace {

/// The chain of masses, and where along the given points each stands: 2.5 is halfway from point 2 to 3.
struct Chain {
  std::vector<Vec3> p, q;
  std::vector<double> where;
};

template <class T>
T between(const std::vector<T>& values, double where) {
  const auto i = std::min(static_cast<std::size_t>(where), values.size() - 2);
  const double f = where - static_cast<double>(i);
  return T((1.0 - f) * values[i] + f * values[i + 1]);
}

/// `count` places, evenly by length along the polyline.
std::vector<double> spread_evenly(const std::vector<Vec3>& points, std::size_t count) {
  std::vector<double> length{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    length.push_back(length.back() + (points[i] - points[i - 1]).stableNorm());
  }
  std::vector<double> where;
  std::size_t edge = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double s = length.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    while (edge + 2 < points.size() && length[edge + 1] < s) ++edge;
    const double part = (s - length[edge]) / (length[edge + 1] - length[edge]);
    where.push_back(static_cast<double>(edge) + std::clamp(part, 0.0, 1.0));
  }
  return where;
}

Chain read_chain(const JsonNode& curve_pair) {
  const JsonNode points = curve_pair.at("points");
  const JsonNode orientation = curve_pair.at("orientation");
  const std::vector<Vec3> given = points.points();
  const double edge = mean_edge(points, given);
  const bool one_direction = orientation.size() > 0 && !orientation.at(0).is_array();
  Chain chain;
  if (!curve_pair.has("nodes")) {
    for (std::size_t i = 0; i < given.size(); ++i) chain.where.push_back(static_cast<double>(i));
    chain.p = given;
    chain.q = read_orientation(orientation, given, edge);
    return chain;
  }
  chain.where = spread_evenly(given, static_cast<std::size_t>(curve_pair.at("nodes").integer(2, 100000)));
  for (const double where : chain.where) chain.p.push_back(between(given, where));
  if (one_direction) {
    chain.q = read_orientation(orientation, chain.p, edge);
  } else {
    const std::vector<Vec3> q = read_orientation(orientation, given, edge);
    for (const double where : chain.where) chain.q.push_back(between(q, where));
  }
  return chain;
}

Material read_material(const JsonNode& material) {
  const double young = material.at("young").positive();
  const double density = material.at("density").positive();
  if (material.has("shear") == material.has("poisson")) {
    material.refuse("shear and poisson", "one of them, not both");
  }
  const double shear = material.has("shear") ? material.at("shear").positive()
                                             : young / (2.0 * (1.0 + material.at("poisson").number()));
  return {young, shear, density};
}

std::vector<double> read_sizes(const JsonNode& size, std::size_t points) {
  if (!size.is_array()) return std::vector<double>(points, size.positive());
  if (size.size() != points) {
    size.refuse(std::to_string(size.size()) + " sizes",
                "one for each of the " + std::to_string(points) + " points");
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < points; ++i) out.push_back(size.at(i).positive());
  return out;
}

/// Sections along a chain: sizes constant or per given point.
class SectionReader {
 public:
  SectionReader(const JsonNode& section, std::size_t points)
      : node_(section), type_(section.at("type").text()) {
    if (type_ == "circular") {
      a_ = read_sizes(node_.at("radius"), points);
      refuse_unused({"a", "b"});
    } else {
      a_ = read_sizes(node_.at("a"), points);
      b_ = read_sizes(node_.at("b"), points);
      refuse_unused({"radius"});
    }
  }

  Section at(double where) const {
    const double a = between(a_, where);
    return node_.locate([&] {
      if (type_ == "circular") return circular_section(a);
      if (type_ == "elliptic") return elliptic_section(a, between(b_, where));
      return rectangular_section(a, between(b_, where));
    });
  }

 private:
  void refuse_unused(const std::vector<std::string>& keys) const {
    for (const std::string& key : keys) {
      if (node_.has(key))
        node_.at(key).refuse("not a size of a section that is " + type_, "radius, or a and b");
    }
  }

  JsonNode node_;
  std::string type_;
  std::vector<double> a_, b_;
};

/// make_rod of the library for one material and section, then scaled by what varies along the chain. Its
/// springs are a constant of the section, E A, E I or G J, over lengths of the chain alone. So a section of
/// its own makes of a spring the ratio of the two constants, at an edge's middle for what stretches and
/// twists and at a node for what bends. Masses are summed anew: a node takes half of either edge's mass, with
/// the section at that edge's middle, so that a taper has the mass of its edges' midpoint rule.
Rod with_sections(const Chain& chain, const Material& material, const SectionReader& sections) {
  const Section first = sections.at(chain.where.front());
  Rod rod = make_rod(chain.p, chain.q, material, first);
  const std::size_t n = chain.p.size();
  std::vector<double> mass(n, 0.0), inertia(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Section s = sections.at(0.5 * (chain.where[i] + chain.where[i + 1]));
    const double half = 0.5 * (chain.p[i + 1] - chain.p[i]).stableNorm();
    for (const std::size_t k : {i, i + 1}) {
      mass[k] += material.density * s.area * half;
      inertia[k] += material.density * s.polar * half;
    }
    rod.stretch[i] *= s.area / first.area;
    rod.twist[i] *= s.torsion / first.torsion;
    rod.width[i] = s.width;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Section s = sections.at(chain.where[i]);
    rod.bend_l[i] *= s.bending1 / first.bending1;
    rod.bend_m[i] *= s.bending2 / first.bending2;
  }
  rod.mass = mass;
  rod.inertia = inertia;
  return rod;
}

SpringConstants read_springs(const JsonNode& springs) {
  SpringConstants out{};
  out.stretch = springs.at("stretch").positive();
  out.bend_l = springs.at("bend_l").not_negative();
  out.bend_m = springs.at("bend_m").not_negative();
  out.bend_t = springs.number_or("bend_t", 0.0);
  out.twist = springs.at("twist").not_negative();
  out.mass = springs.at("mass").positive();
  out.inertia = springs.at("inertia").positive();
  out.width = springs.number_or("width", 0.0);
  return out;
}

/// Masses, or discs across the rod, fixed to nodes.
void add_masses(const JsonNode& curve_pair, Rod& rod) {
  if (!curve_pair.has("masses")) return;
  const JsonNode masses = curve_pair.at("masses");
  for (std::size_t k = 0; k < masses.size(); ++k) {
    const std::size_t node = read_node(masses.at(k).at("node"), rod);
    rod.mass[node] += masses.at(k).at("mass").positive();
    rod.inertia[node] += masses.at(k).number_or("inertia", 0.0);
  }
}

}  // namespace

Rod read_rod(const JsonNode& curve_pair) {
  const Chain chain = read_chain(curve_pair);
  const bool springs = curve_pair.has("springs");
  if (springs == (curve_pair.has("material") || curve_pair.has("section"))) {
    curve_pair.refuse(springs ? "springs as well as material or section" : "neither springs nor material",
                      "either springs, or material and section");
  }
  Rod rod = curve_pair.locate([&] {
    if (springs) return make_rod(chain.p, chain.q, read_springs(curve_pair.at("springs")));
    return with_sections(chain, read_material(curve_pair.at("material")),
                         SectionReader(curve_pair.at("section"), curve_pair.at("points").size()));
  });
  add_masses(curve_pair, rod);
  rod.mass_damping = curve_pair.number_or("mass_damping", 0.0);
  rod.viscosity = curve_pair.number_or("viscosity", 0.0);
  return rod;
}

std::vector<double> read_along(const JsonNode& curve_pair, const std::string& key) {
  const std::vector<double> sizes = read_sizes(curve_pair.at(key), curve_pair.at("points").size());
  std::vector<double> out;
  for (const double where : read_chain(curve_pair).where) out.push_back(between(sizes, where));
  return out;
}

std::size_t read_node(const JsonNode& node, const Rod& rod) {
  const long last = static_cast<long>(rod.p.size()) - 1;
  const long i = node.integer(-1, last);
  return static_cast<std::size_t>(i < 0 ? last : i);
}

}  // namespace tendril::scene
