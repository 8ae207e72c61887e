#pragma once

#include <vector>

#include "off_header.h"

namespace tendril::bind {

/// What follows the three coordinates in a vertex' line.
struct OffColumn {
  enum Kind { normal, color, texture } kind;
  std::size_t count;  ///< of numbers
};

/// Columns that a text OFF's prefix does not tell, or tells in another order than its data have; none where
/// the file is as its prefix says.
///
/// Read free-form, a plain OFF with more than three numbers a vertex is another mesh. That is seen by its
/// lines: as many as vertices and faces, as many numbers in each vertex' line, and a face in each of the
/// others. What the numbers are is told by their values: normals are unit vectors, colors 0..255 or 0..1.
/// Where that leaves a doubt, and where nobody is told, the file is refused at its first vertex.
/// NCOFF with the color before the normal, as one widespread exporter writes it, is seen in the same way.
/// \param in  at the first vertex
std::vector<OffColumn> off_columns(TextCursor in, const OffHeader& header, const Notes& notes);

}  // namespace tendril::bind
