#pragma once

#include "io/values/cursor.h"

namespace tendril::bind {

enum class StlKind { none, text, binary };

/// Where the count of facets stands in a binary file, and what follows it.
inline constexpr std::size_t kStlCount = 80, kStlBegin = 84, kStlFacet = 50;

/// What the bytes are by themselves: binary where their number is exactly what the count of facets says,
/// whatever the 80 bytes of the header hold, even the word "solid"; text where that is the first word and no
/// byte before the count is one that text has not.
StlKind stl_kind(std::string_view bytes);

}  // namespace tendril::bind
