#pragma once

#include <tendril/bind/inspect.h>

#include <span>

namespace tendril::bind {

/// Some faces of a mesh, each as it is or turned over: whether they close, and what they enclose.
class ClosedPart {
 public:
  struct Face {
    std::uint32_t id;
    bool turned;
  };
  ClosedPart(const PolygonMesh& mesh, std::span<const Face> faces);

  /// Every edge is used as often in either direction.
  bool is_closed() const { return closed_; }
  /// Signed, positive where the faces look outward, of fans from their first corners. About the part's own
  /// first point and in units of its own size, so that neither a far place nor a huge size loses it: its sign
  /// alone says something.
  double volume() const { return volume_; }

 private:
  bool closed_ = false;
  double volume_ = 0.0;
};

/// Whether a part lies within others: the winding number of the rest of the mesh about its first point is not
/// 0. Then either way round is right, a cavity's as a kernel's.
bool nested(const PolygonMesh& mesh, std::span<const ClosedPart::Face> part);
/// Whether a part lies within another.
bool within(const PolygonMesh& mesh, std::span<const std::uint32_t> part,
            std::span<const std::uint32_t> other);

/// Faces joined by edges that two of them use, part after part in the order of their first faces.
std::vector<std::vector<ClosedPart::Face>> parts_of(const PolygonMesh& mesh);

}  // namespace tendril::bind
