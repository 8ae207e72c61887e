#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#include <tendril/base/file.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "bench/binding/sections.h"
#include "bench/clock.h"
#include "support/mesh_files.h"
#ifdef TENDRIL_BENCH_OPENMESH
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#endif

namespace tendril::bench {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;

/// A wavy sheet of triangles.
bind::PolygonMesh sheet(std::uint32_t side) {
  bind::PolygonMesh mesh;
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j)
      mesh.points.emplace_back(i * 0.001, j * 0.001, 0.1 * std::sin(0.01 * i) * std::cos(0.013 * j));
  for (std::uint32_t i = 0; i + 1 < side; ++i)
    for (std::uint32_t j = 0; j + 1 < side; ++j) {
      const std::uint32_t a = side * i + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + side, a + side + 1, a, a + side + 1, a + 1});
      for (int k = 0; k < 2; ++k) mesh.face_begin.push_back(mesh.face_begin.back() + 3);
    }
  return mesh;
}

std::string ply_text(const bind::PolygonMesh& mesh) {
  std::string out = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.points.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh.face_count()) +
                    "\nproperty list uchar int vertex_indices\nend_header\n";
  // Past its two header lines an OFF file holds the same lines.
  const std::string off = bind::off_text(mesh);
  return out.append(off, off.find('\n', off.find('\n') + 1) + 1);
}

std::string off_binary(const bind::PolygonMesh& mesh) {
  std::string out = "OFF BINARY\n";
  const auto put = [&](std::uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(word >> shift & 255));
  };
  put(static_cast<std::uint32_t>(mesh.points.size()));
  put(static_cast<std::uint32_t>(mesh.face_count()));
  put(0);
  for (const Vec3& p : mesh.points)
    for (const double x : p) put(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    put(3);
    for (const std::uint32_t corner : mesh.face(f)) put(corner);
    put(0);
  }
  return out;
}

struct Kind {
  const char* name;
  const char* extension;
  bool binary;
  std::string (*bytes)(const bind::PolygonMesh&);

  bool is(const char* format) const { return std::string(name).starts_with(format); }
  /// Whether what was read is what was written, bit for bit where the format has double precision. STL has
  /// its points in another order.
  bool holds(const bind::PolygonMesh& read, const bind::PolygonMesh& mesh) const {
    if (read.points.size() != mesh.points.size() || read.corners.size() != mesh.corners.size()) return false;
    const bool single = binary && !is("PLY");
    for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
      const Vec3 &a = read.points[read.corners[c]], &b = mesh.points[mesh.corners[c]];
      if (single ? a != b.cast<float>().cast<double>() : a != b) return false;
    }
    return is("STL") || read.corners == mesh.corners;
  }
};
using Soup = std::vector<std::vector<std::size_t>>;

/// Seconds, or none when the file was not read in full.
double timed(int repeats, std::size_t vertices, const std::function<std::size_t()>& read) {
  std::size_t got = 0;
  double seconds = 0.0;
  try {
    seconds = fastest(repeats, [&] { got = read(); });
  } catch (const std::exception&) {  // one peer asks for more memory than there is
    got = 0;
  }
  return got == vertices ? seconds : std::nan("");
}

double cgal_mesh(const std::string& path, int repeats, std::size_t vertices) {
  return timed(repeats, vertices, [&] {
    CGAL::Surface_mesh<Point> mesh;
    CGAL::IO::read_polygon_mesh(path, mesh);
    return std::size_t{mesh.number_of_vertices()};
  });
}

double cgal_soup(const std::string& path, int repeats, std::size_t vertices) {
  return timed(repeats, vertices, [&] {
    std::vector<Point> points;
    Soup faces;
    CGAL::IO::read_polygon_soup(path, points, faces);
    return points.size();
  });
}

double open_mesh([[maybe_unused]] const std::string& path, [[maybe_unused]] const Kind& kind,
                 [[maybe_unused]] int repeats, [[maybe_unused]] std::size_t vertices) {
#ifdef TENDRIL_BENCH_OPENMESH
  return timed(repeats, vertices, [&] {
    OpenMesh::TriMesh_ArrayKernelT<> mesh;
    OpenMesh::IO::Options options;
    if (kind.binary) options += OpenMesh::IO::Options::Binary;
    OpenMesh::IO::read_mesh(mesh, path, options);
    return std::size_t{mesh.n_vertices()};
  });
#else
  return std::nan("");
#endif
}

}  // namespace

OrderedJson reading_section(Settings& settings) {
  const std::uint32_t side = settings.quick ? 300 : 1000;
  heading("reading", "milliseconds for a file of " + std::to_string(side * side) +
                         " vertices and two triangles each; a peer's: how many times ours; nan: not read");
  const bind::PolygonMesh mesh = sheet(side);
  const auto folder = std::filesystem::temp_directory_path() / "tendril_binding_bench";
  std::filesystem::create_directories(folder);
  Table table({"file", "MB", "ours", "CGAL Surface_mesh", "CGAL polygon soup", "OpenMesh"});
  OrderedJson out;
  for (const Kind& kind :
       {Kind{"OFF text", ".off", false, bind::off_text}, Kind{"OFF binary", ".off", true, off_binary},
        Kind{"PLY text", ".ply", false, ply_text},
        Kind{"PLY binary", ".ply", true, [](const auto& m) { return bind::ply_bytes(m); }},
        Kind{"OBJ", ".obj", false, test::obj_text},
        Kind{"STL text", ".stl", false, [](const auto& m) { return test::stl_text(m); }},
        Kind{"STL binary", ".stl", true, [](const auto& m) { return test::stl_bytes(m); }}}) {
    const std::string path = (folder / (std::string("sheet") + kind.extension)).string();
    write_file_whole(path, kind.bytes(mesh));
    bind::PolygonMesh read;
    const double ours = fastest(settings.quick ? 3 : 5, [&] { read = bind::read_mesh(path); });
    if (!kind.holds(read, mesh))
      settings.broken.push_back(std::string(kind.name) + " does not come back bit for bit");
    std::vector<std::string> row{kind.name,
                                 text("%.0f", 1e-6 * static_cast<double>(std::filesystem::file_size(path))),
                                 text("%.0f", 1e3 * ours)};
    OrderedJson entry{{"file", kind.name}, {"ms", 1e3 * ours}};
    const int repeats = settings.quick ? 1 : 2;
    const auto peer = [&](const char* name, double seconds) {
      row.push_back(text("%.1f", seconds / ours));
      entry[name] = seconds / ours;
    };
    peer("cgal_surface_mesh", cgal_mesh(path, repeats, mesh.points.size()));
    peer("cgal_polygon_soup", cgal_soup(path, repeats, mesh.points.size()));
    peer("open_mesh", open_mesh(path, kind, repeats, mesh.points.size()));
    table.row(row);
    out.push_back(entry);
  }
  table.print();
  std::filesystem::remove_all(folder);
  return out;
}

}  // namespace tendril::bench
