#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/import.h>

#include <chrono>
#include <cstdlib>
#include <new>

#include "mesh_text.h"

namespace {

std::size_t allocated = 0;  // bytes asked for since it was last set to 0; this program has one thread

}  // namespace

// Counts what the readers ask for. Bytes given back are not subtracted, so this is above any peak. Inlined on
// one side alone, the two would look like a mismatch to the compiler.
[[gnu::noinline]] void* operator new(std::size_t size) {
  allocated += size;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tendril::bind {
namespace {

using Parse = PolygonMesh (*)(std::string_view, const std::string&);

void expect_bounded(const std::string& bytes, Parse parse) {
  allocated = 0;
  try {
    parse(bytes, "a");
  } catch (const InvalidInput&) {
  }
  EXPECT_LT(allocated, 16384 + 80 * bytes.size()) << bytes.substr(0, 100);
}

std::string ply(const std::string& vertices, const std::string& faces, const std::string& format) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty uchar x\nproperty uchar y\nproperty uchar z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nelement face " +
         faces +
         "\nproperty list uint uint vertex_indices\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nend_header\n";
}

TEST(ImportMemory, IsBoundedByTheBytesWhateverTheHeaderSays) {
  for (const char* prefix : {"", "C", "N", "STCN"}) {
    expect_bounded(std::string(prefix) + "OFF\n4000000000 4000000000 0\n0 0 0\n", parse_off);
  }
  expect_bounded("OFF\n0 4000000000 0\n3", parse_off);
  expect_bounded("OFF\n1 1 0\n0 0 0\n4000000000 0 0", parse_off);
  Bytes counts("OFF BINARY\n", true);
  expect_bounded(counts.put(0x7fffffff, 0x7fffffff, 0).put(0.0F, 0.0F).str(), parse_off);
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    expect_bounded(ply("4294967295", "4294967295", format) + "1 2 3", parse_ply);
    expect_bounded(ply("0", "18446744073709551615", format), parse_ply);
    expect_bounded(ply("0", "1", format) + std::string(4, '\x3f'), parse_ply);
  }
}

TEST(ImportMemory, IsBoundedForObjAndStl) {
  std::string obj = "v 0 0 0 1 0 0\nvn 0 0 1\nvt 0 0\n";
  for (int i = 0; i < 20000; ++i) obj += "v 0 0 0\n";
  for (int i = 0; i < 20000; ++i) obj += "f 1/1/1 1 1\n";
  expect_bounded(obj, parse_obj);
  expect_bounded(obj + "f 1 2 99999999\n", parse_obj);  // read twice
  std::string header(80, ' ');
  Bytes counted(header, false);
  expect_bounded(counted.put(std::uint32_t{0xffffffff}).str(), parse_stl);
  expect_bounded(Bytes(header, false).put(std::uint32_t{50000000}).str() + std::string(200, '\1'), parse_stl);
  PolygonMesh apart;  // no two corners at one place
  for (std::uint32_t i = 0; i < 60000; ++i) {
    apart.points.emplace_back(i, 0, 0);
    apart.corners.push_back(i);
    if (i % 3 == 2) apart.face_begin.push_back(i + 1);
  }
  expect_bounded(stl_bytes(apart), parse_stl);
  expect_bounded(stl_text(apart), parse_stl);
}

TEST(ImportMemory, IsBoundedForTheDensestFiles) {
  std::string off = "OFF 20000 20000 0\n";
  for (int i = 0; i < 20000; ++i) off += "0 0 0\n";
  for (int i = 0; i < 20000; ++i) off += "3 0 0 0\n";
  expect_bounded(off, parse_off);
  const std::string head = ply("20000", "0", "binary_little_endian");
  expect_bounded(head + std::string(120000, '\1'), parse_ply);
  EXPECT_EQ(parse_ply(head + std::string(120000, '\1'), "a").points.size(), 20000);
}

/// Elements without properties take no bytes; counting through 1e18 of them would take years.
TEST(ImportTime, DoesNotFollowTheHeadersCounts) {
  const auto start = std::chrono::steady_clock::now();
  const std::string empty =
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\n"
      "element nothing 1000000000000000000\nend_header\n";
  EXPECT_EQ(parse_ply(empty, "a").points.size(), 0);
  EXPECT_THROW(parse_ply("ply\nformat pl1.0", "a"), InvalidInput);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

}  // namespace
}  // namespace tendril::bind
