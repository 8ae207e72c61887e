#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>

#include <cstdio>

#include "bench/binding/sections.h"
#include "bench/clock.h"

namespace tendril::bench {

double arap_seconds(const Settings& settings, const std::string& name) {
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  using Deformation = CGAL::Surface_mesh_deformation<Mesh, CGAL::Default, CGAL::Default, CGAL::ORIGINAL_ARAP>;
  Mesh mesh;
  if (!CGAL::IO::read_OFF(settings.meshes + "/" + name, mesh)) {
    std::printf("no %s in %s: CGAL's deformation left out\n", name.c_str(), settings.meshes.c_str());
    return 0.0;
  }
  Deformation deformation(mesh);
  deformation.insert_roi_vertices(vertices(mesh).begin(), vertices(mesh).end());
  std::size_t k = 0;
  std::vector<Mesh::Vertex_index> held;
  for (const auto v : mesh.vertices())
    if (k++ % 2000 == 0) held.push_back(v);
  deformation.insert_control_vertices(held.begin(), held.end());
  if (!deformation.preprocess()) return 0.0;
  double step = 0.0;
  return fastest(settings.quick ? 1 : 3, [&] {
    step += 0.01;
    for (const auto v : held) {
      const auto& p = mesh.point(v);
      deformation.set_target_position(v, {p.x() + step * p.y(), p.y(), p.z()});
    }
    deformation.deform(5, 0.0);
  });
}

}  // namespace tendril::bench
