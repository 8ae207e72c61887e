#pragma once

#include <tendril/contact/surface_contact.h>

#include <array>
#include <cstdint>
#include <vector>

#include "contact/surfaces/span_motion.h"

namespace tendril::contact {

struct SelfEdge {
  std::array<std::uint32_t, 2> end;
  std::uint32_t face;    ///< one of its
  double area = 0.0;     ///< a third of that of its faces
  double longest = 0.0;  ///< side of its faces
};

/// Some triangles of one part that depend on the same spans of curve-pairs.
struct SelfPatch {
  std::vector<std::uint32_t> faces;
  std::vector<std::uint32_t> vertices, edges;  ///< each is of one patch alone
  std::vector<std::uint32_t> corners;          ///< all vertices of its faces, ascending
  std::vector<std::uint32_t> spans;            ///< of SelfMesh::spans, ascending
  std::uint32_t part = 0;
};

/// Vertices of several sets one after the other, those of set i from begin[i] on; each set's last is repeated
/// until it has a multiple of kLane.
struct VertexSets {
  static constexpr std::size_t kLane = 8;
  std::vector<std::uint32_t> vertices, begin{0};

  /// \param set  not empty
  void add(const std::vector<std::uint32_t>& set);
  std::size_t size() const { return begin.size() - 1; }
};

/// A surface as it rests, as something that meets itself.
struct SelfMesh {
  /// \param surface  checked
  explicit SelfMesh(const ContactSurface& surface);

  std::vector<UsedSpan> spans;
  std::vector<std::vector<std::uint32_t>> bound_to;  ///< per span: vertices with a share in it
  std::vector<SelfPatch> patches;
  /// Patches of a part follow each other: those of the i-th from part_begin[i] on.
  std::vector<std::uint32_t> part_begin;
  VertexSets corners_of_patches, corners_of_parts;
  /// The spans of all patches one after the other, those of p from spans_begin[p] on; and per patch, the
  /// corners of a face in its midst.
  std::vector<std::uint32_t> spans_of, spans_begin;
  std::vector<std::array<std::uint32_t, 3>> amidst;
  std::vector<SelfEdge> edges;
  std::vector<std::array<std::uint32_t, 3>> edges_of;  ///< per face; edge i from corner i to the next
  std::vector<double> area;                            ///< per vertex: a third of that of its faces
  std::vector<double> longest, face_longest;           ///< sides, of a vertex' faces and of a face
  std::vector<std::uint32_t> face_of;                  ///< per vertex: one that it is a corner of
  std::vector<std::uint32_t> part;                     ///< per vertex: of what faces connect

 private:
  void find_edges(const ContactSurface& surface);
  void measure(const ContactSurface& surface);
  void find_parts(const ContactSurface& surface);
  void find_patches(const ContactSurface& surface);
  void line_up(const ContactSurface& surface);
};

}  // namespace tendril::contact
