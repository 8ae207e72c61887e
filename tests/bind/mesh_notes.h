#pragma once

#include <tendril/base/file.h>
#include <tendril/bind/import.h>
#include <unistd.h>

#include <cstdio>

#include "mesh_text.h"

namespace tendril::bind {

/// What read_mesh makes of a file, and its notes without the file's name, a line each.
struct Told {
  PolygonMesh mesh;
  std::string notes;
};

inline Told read_told(const std::string& bytes, const std::string& ending) {
  const std::string path = testing::TempDir() + "tendril-told-" + std::to_string(::getpid()) + ending;
  write_file_whole(path, bytes);
  std::vector<std::string> notes;
  Told out{read_mesh(path, &notes), ""};
  for (const std::string& note : notes) out.notes += note.substr(path.size()) + "\n";
  std::remove(path.c_str());
  return out;
}

struct BadFile {
  std::string bytes;
  std::string place;   // after the name: a line, or "byte N"
  std::string reason;  // a part of it
};

inline void expect_refused(const BadFile& bad, PolygonMesh (*parse)(std::string_view, const std::string&)) {
  SCOPED_TRACE(testing::PrintToString(bad.bytes.substr(0, 200)));
  try {
    const PolygonMesh mesh = parse(bad.bytes, "bad");
    ADD_FAILURE() << "accepted with " << mesh.points.size() << " points";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.place(), "bad:" + bad.place) << error.what();
    EXPECT_NE(error.reason().find(bad.reason), std::string::npos) << error.what();
    EXPECT_FALSE(error.expected().empty());
  }
}

}  // namespace tendril::bind
