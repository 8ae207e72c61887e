#pragma once

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "support/random.h"

/// Meshes, curves, poses and scenes that are odd, as files.
namespace tendril::test {

struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;
};

/// A closed tube round the x axis.
inline Mesh tube(int rings, int sides, double radius) {
  Mesh mesh;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      const double angle = 6.283185307179586 * k / sides;
      mesh.points.emplace_back(static_cast<double>(i) / (rings - 1), radius * std::cos(angle),
                               radius * std::sin(angle));
    }
  for (int i = 0; i + 1 < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      const int a = i * sides + k, b = i * sides + (k + 1) % sides;
      mesh.faces.push_back({a, a + sides, b + sides, b});
    }
  std::vector<int> first, last;
  for (int k = 0; k < sides; ++k) {
    first.push_back(k);
    last.push_back((rings - 1) * sides + sides - 1 - k);
  }
  mesh.faces.push_back(first);
  mesh.faces.push_back(last);
  return mesh;
}

inline Mesh plain_mesh(Random& random) {
  switch (random.integer(6)) {
    case 0:
      return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
              {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    case 1:
      return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, 1, 0)}, {{0, 1, 2}}};
    case 2: {  // a flat sheet
      Mesh mesh = tube(5, 6, 0.2);
      for (Vec3& p : mesh.points) p.z() = 0.0;
      return mesh;
    }
    case 3: {  // two parts
      Mesh mesh = tube(4, 5, 0.1);
      const Mesh other = tube(3, 4, 0.3);
      const auto n = static_cast<int>(mesh.points.size());
      for (const Vec3& p : other.points) mesh.points.push_back(p + Vec3(0.2, 0.5, 0));
      for (std::vector<int> face : other.faces) {
        for (int& i : face) i += n;
        mesh.faces.push_back(face);
      }
      return mesh;
    }
    default: {
      const int rings = 3 + random.integer(8), sides = 3 + random.integer(6);
      return tube(rings, sides, random.uniform(0.02, 0.4));
    }
  }
}

inline double odd_number(Random& random) {
  const double all[] = {0.0,   -0.0,  1.0,     -1.0,   1e-320, 5e-324, 1e-160, 1e-30, 1e15, 1e30,
                        1e154, 1e200, 1.7e308, -1e308, 0.5,    3e38,   1e-8,   1e6,   2.0,  -1e30};
  if (random.integer(3) == 0) return random.uniform(-2.0, 2.0);
  return all[random.integer(static_cast<int>(std::size(all)))];
}

template <class T>
T& any_of(std::vector<T>& values, Random& random) {
  return values[static_cast<std::size_t>(random.integer(static_cast<int>(values.size())))];
}

inline void scale(std::vector<Vec3>& points, double by) {
  for (Vec3& p : points) p *= by;
}

inline void disturb(std::vector<Vec3>& points, Random& random) {
  if (points.empty()) return;
  switch (random.integer(9)) {
    case 0:
      return scale(points, std::pow(10.0, random.uniform(-320.0, 308.0)));
    case 1:
      any_of(points, random)[random.integer(3)] = odd_number(random);
      return;
    case 2:  // to one place
      for (int k = 0; k < 3; ++k) any_of(points, random) = points.front();
      return;
    case 3:
      for (Vec3& p : points) p += Vec3::Constant(std::pow(10.0, random.uniform(0.0, 300.0)));
      return;
    case 4: {
      const int axis = random.integer(3);
      for (Vec3& p : points) p[axis] = 0.0;
      return;
    }
    case 5:
      std::reverse(points.begin(), points.end());
      return;
    case 6:
      for (Vec3& p : points) p += random.in_cube(0.2);
      return;
    case 7:
      points.push_back(points.front());
      return;
    default:
      points.pop_back();
  }
}

inline void disturb(Mesh& mesh, Random& random) {
  if (mesh.faces.empty() || random.integer(2) == 0) return disturb(mesh.points, random);
  switch (random.integer(6)) {
    case 0:
      mesh.faces.pop_back();
      return;
    case 1:
      mesh.faces.push_back(mesh.faces.front());
      return;
    case 2: {
      std::vector<int>& face = any_of(mesh.faces, random);
      std::reverse(face.begin(), face.end());
      return;
    }
    case 3:
      any_of(any_of(mesh.faces, random), random) = random.integer(40) - 2;
      return;
    case 4:
      for (std::vector<int>& face : mesh.faces) std::reverse(face.begin(), face.end());
      return;
    default:
      any_of(mesh.faces, random).pop_back();
      mesh.faces.erase(
          std::remove_if(mesh.faces.begin(), mesh.faces.end(), [](const auto& f) { return f.empty(); }),
          mesh.faces.end());
  }
}

/// Now and then a word in place of a number, or a part of the file is gone or there twice.
inline std::string damaged(std::string text, Random& random) {
  if (random.integer(6) != 0 || text.size() < 20) return text;
  const auto at = static_cast<std::size_t>(random.integer(static_cast<int>(text.size())));
  const char* words[] = {"nan", "inf", "-", "1e999", "\n", " ", "999999999999", "{", "\xff", "-1"};
  switch (random.integer(3)) {
    case 0:
      return text.substr(0, at);
    case 1:
      return text.substr(0, at) + text.substr(at / 2);
    default:
      return text.replace(at, 1, words[random.integer(static_cast<int>(std::size(words)))]);
  }
}

inline void put(std::ostream& out, const Vec3& p) {
  out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
}

inline std::string mesh_text(const Mesh& mesh, const std::string& extension) {
  std::ostringstream out;
  out.precision(17);
  if (extension == "off") out << "OFF\n" << mesh.points.size() << ' ' << mesh.faces.size() << " 0\n";
  if (extension == "ply")
    out << "ply\nformat ascii 1.0\nelement vertex " << mesh.points.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.faces.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : mesh.points) {
    if (extension == "obj") out << "v ";
    put(out, p);
  }
  for (const std::vector<int>& face : mesh.faces) {
    if (extension == "obj")
      out << 'f';
    else
      out << face.size();
    for (const int i : face) out << ' ' << (extension == "obj" ? i + 1 : i);
    out << '\n';
  }
  return out.str();
}

inline std::string list(const std::vector<Vec3>& points) {
  std::ostringstream out;
  out.precision(17);
  out << '[';
  for (std::size_t i = 0; i < points.size(); ++i)
    out << (i ? ", " : "") << '[' << points[i].x() << ", " << points[i].y() << ", " << points[i].z() << ']';
  out << ']';
  return out.str();
}

inline std::vector<Vec3> line(int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(static_cast<double>(i) / (count - 1), 0.0, 0.0);
  return points;
}

struct Curve {
  std::vector<Vec3> points;
  std::string orientation;
};

inline std::string curve_text(const Curve& curve) {
  return R"({"version": 1, "points": )" + list(curve.points) + R"(, "orientation": )" + curve.orientation +
         "}";
}

inline Curve any_curve(Random& random) {
  const char* sides[] = {"[0, 1, 0]", "[0, 0, 1]",      "[1, 0, 0]",
                         "[0, 0, 0]", "[1e-200, 1, 0]", "[0, 1e300, 0]"};
  Curve curve{line(2 + random.integer(9)), sides[random.integer(2)]};
  if (random.integer(6) == 0) curve.orientation = sides[random.integer(static_cast<int>(std::size(sides)))];
  return curve;
}

/// The curve bent, or something else.
inline Curve any_pose(const Curve& rest, Random& random) {
  Curve pose = rest;
  const double bend = random.uniform(-4.0, 4.0);
  for (Vec3& p : pose.points) {
    const double x = p.x();
    p = std::abs(bend) > 0.01 ? Vec3(std::sin(bend * x) / bend, (1 - std::cos(bend * x)) / bend, 0) : p;
  }
  if (random.integer(2) == 0) pose.orientation = "[0, 0, 1]";
  return pose;
}

inline std::string number(Random& random) {
  std::ostringstream out;
  out.precision(17);
  out << odd_number(random);
  return out.str();
}

inline std::string scene_text(const Curve& curve, const std::string& mesh, Random& random) {
  const auto or_odd = [&](const char* usual) {
    return random.integer(8) == 0 ? number(random) : std::string(usual);
  };
  std::string text = R"({"version": 1, "mesh": ")" + mesh +
                     R"(", "curve_pairs": [{"name": "rod", "points": )" + list(curve.points) +
                     R"(, "orientation": )" + curve.orientation + R"(, "nodes": )" +
                     std::to_string(2 + random.integer(12)) + R"(, "material": {"young": )" + or_odd("1e5") +
                     R"(, "poisson": )" + or_odd("0.3") + R"(, "density": )" + or_odd("1000") +
                     R"(}, "section": {"type": "circular", "radius": )" + or_odd("0.05") + R"(}, "reach": )" +
                     or_odd("2") + R"(, "mass_damping": )" + or_odd("0.5") + R"(, "viscosity": )" +
                     or_odd("0.001") + R"(, "anchors": [{"node": )" + std::to_string(random.integer(3)) +
                     R"(}]}], "forces": [{"type": "gravity", "acceleration": [0, )" + or_odd("-9.81") +
                     R"(, 0]}, {"type": "wind", "mean": [)" + or_odd("2") + R"(, 0, 0], "gust": )" +
                     or_odd("0.5") + R"(}], "simulation": {"duration": )" + or_odd("0.05") +
                     R"(, "tolerance": )" + or_odd("1e-3") + R"(, "frames": 3, "work_limit": 20000}})";
  return text;
}

}  // namespace tendril::test
