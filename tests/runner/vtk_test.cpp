#include <gtest/gtest.h>
#include <tendril/bind/import.h>

#include <cstring>
#include <regex>

#include "runner/program.h"

namespace tendril::test {
namespace {

/// Reads what a file of raw appended arrays declares, by the letter of the format.
class VtuReader {
 public:
  explicit VtuReader(const std::string& path) : text_(bytes_of(path)) {
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    data_ = text_.find(mark) + mark.size();
    EXPECT_NE(text_.find(mark), std::string::npos) << path;
  }

  template <class T>
  std::vector<T> array(const std::string& name, const std::string& type) const {
    const std::regex tag("<DataArray type=\"" + type + "\" Name=\"" + name + "\"[^>]* offset=\"([0-9]+)\"/>");
    std::smatch found;
    const std::string xml = text_.substr(0, data_);
    if (!std::regex_search(xml, found, tag)) {
      ADD_FAILURE() << "no array " << name;
      return {};
    }
    const std::size_t at = data_ + std::stoul(found[1]);
    std::uint64_t size = 0;
    std::memcpy(&size, text_.data() + at, 8);
    std::vector<T> out(size / sizeof(T));
    std::memcpy(out.data(), text_.data() + at + 8, size);
    return out;
  }

  std::size_t count(const std::string& what) const {
    std::smatch found;
    const std::string xml = text_.substr(0, data_);
    return std::regex_search(xml, found, std::regex(what + "=\"([0-9]+)\"")) ? std::stoul(found[1]) : 0;
  }

 private:
  std::string text_;
  std::size_t data_;
};

struct MovedTube {
  Folder folder;
  MovedTube() {
    folder.write("tube.off", tube_off());
    folder.write("s.json", full_scene());
    const Outcome run = folder.run("run s.json --out out --double --vtk --no-pictures");
    EXPECT_EQ(run.code, 0) << run.err;
  }
};

TEST(Vtk, ReadsBackToTheBitsOfTheMesh) {
  const MovedTube run;
  const bind::PolygonMesh frame = bind::read_mesh(run.folder / "out/frame_0002.ply");
  const VtuReader vtu(run.folder / "out/mesh_0002.vtu");
  const std::vector<double> points = vtu.array<double>("Points", "Float64");
  ASSERT_EQ(points.size(), 3 * frame.points.size());
  EXPECT_EQ(std::memcmp(points.data(), frame.points.data(), 8 * points.size()), 0);
  const auto corners = vtu.array<std::int64_t>("connectivity", "Int64");
  ASSERT_EQ(corners.size(), frame.corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_EQ(corners[i], frame.corners[i]);
  const auto ends = vtu.array<std::int64_t>("offsets", "Int64");
  ASSERT_EQ(ends.size(), frame.face_count());
  for (std::size_t f = 0; f < ends.size(); ++f) EXPECT_EQ(ends[f], frame.face_begin[f + 1]);
  for (const std::uint8_t kind : vtu.array<std::uint8_t>("types", "UInt8")) EXPECT_EQ(kind, 7);
  EXPECT_EQ(vtu.count("NumberOfPoints"), frame.points.size());
  EXPECT_EQ(vtu.count("NumberOfCells"), frame.face_count());
}

TEST(Vtk, FieldsSayWhatTheyAreNamedFor) {
  const MovedTube run;
  const VtuReader first(run.folder / "out/mesh_0000.vtu"), vtu(run.folder / "out/mesh_0002.vtu");
  const auto rest = first.array<double>("Points", "Float64"), now = vtu.array<double>("Points", "Float64");
  const auto moved = vtu.array<double>("displacement", "Float64");
  ASSERT_EQ(moved.size(), now.size());
  double most = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_NEAR(now[i] - rest[i], moved[i], 1e-14);
    most = std::max(most, std::abs(moved[i]));
  }
  EXPECT_GT(most, 1e-4);
  for (const std::int32_t follows : vtu.array<std::int32_t>("follows", "Int32")) EXPECT_EQ(follows, 1);
  for (const std::int32_t shares : vtu.array<std::int32_t>("shares", "Int32")) EXPECT_GE(shares, 1);
  const VtuReader rods(run.folder / "out/rods_0002.vtu");
  const auto director = rods.array<double>("director", "Float64");
  for (std::size_t i = 0; i < director.size(); i += 3)
    EXPECT_NEAR(std::hypot(director[i], director[i + 1], director[i + 2]), 1.0, 1e-12);
  EXPECT_GT(rods.array<double>("kinetic_energy", "Float64").at(0), 0.0);
  const std::string pvd = bytes_of(run.folder / "out/run.pvd");
  EXPECT_NE(pvd.find("part=\"0\" file=\"mesh_0002.vtu\""), std::string::npos);
  EXPECT_NE(pvd.find("part=\"1\" file=\"rods_0002.vtu\""), std::string::npos);
}

TEST(Vtk, IsReadByVtkAndMeshioWhereInstalled) {
  const MovedTube run;
  const bind::PolygonMesh frame = bind::read_mesh(run.folder / "out/frame_0002.ply");
  run.folder.write("read.py", R"(import sys
def check(points):
    import struct
    sys.stdout.buffer.write(b''.join(struct.pack('<3d', *map(float, p)) for p in points))
if sys.argv[1] == 'meshio':
    import meshio
    check(meshio.read('out/mesh_0002.vtu').points)
else:
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName('out/mesh_0002.vtu')
    reader.Update()
    grid = reader.GetOutput()
    check([grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())])
)");
  // Debian's own interpreter, which its packages are for; another may stand before it in the path.
  const std::string python = "/usr/bin/python3";
  int readers = 0;
  for (const std::string name : {"meshio", "vtkmodules.vtkIOXML"}) {
    if (std::system((python + " -c 'import " + name + "' >/dev/null 2>&1").c_str()) != 0) continue;
    ++readers;
    const std::string command =
        "cd '" + run.folder.path().string() + "' && " + python + " read.py " + name + " > points.bin";
    ASSERT_EQ(std::system(command.c_str()), 0) << name;
    const std::string points = bytes_of(run.folder / "points.bin");
    ASSERT_EQ(points.size(), sizeof(Vec3) * frame.points.size()) << name;
    EXPECT_EQ(std::memcmp(points.data(), frame.points.data(), points.size()), 0) << name;
  }
  if (readers == 0) GTEST_SKIP() << "neither meshio (python3-meshio) nor VTK (python3-vtk9) is installed";
}

}  // namespace
}  // namespace tendril::test
