#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/values/cursor.h"
#include "io/values/import_values.h"

/// The header of a PLY file: which elements follow, how many of each, and what one of them is made of.
namespace tendril::bind {

struct PlyProperty {
  std::string_view name;
  Scalar type;                       // of the value, or of a list's entries
  std::optional<Scalar> count_type;  // of a list's length; none for a single value
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;

  const PlyElement* find(std::string_view name) const;
};

/// Reads up to and with the line "end_header". Names are views on the input. Tolerant, lines that begin with
/// an unknown word are passed over: comments whose first word was forgotten.
PlyHeader read_ply_header(TextCursor& in, const Notes& notes);

}  // namespace tendril::bind
