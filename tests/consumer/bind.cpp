#include <tendril/bind/polygon_mesh.h>

#include <iostream>

int main() {
  tendril::bind::PolygonMesh mesh;
  mesh.points = {tendril::Vec3(0, 0, 0), tendril::Vec3(3, 4, 12)};
  if (tendril::bind::bounding_diagonal(mesh.points) != 13.0) return 1;
  std::cout << "bind works\n";
}
