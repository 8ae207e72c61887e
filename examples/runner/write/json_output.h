#pragma once

#include <tendril/base/number.h>
#include <tendril/base/types.h>
#include <tendril/bind/distortion.h>
#include <tendril/curve/frames.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tendril::runner {

/// Keys stay in the order they were set.
using OrderedJson = nlohmann::ordered_json;

/// [x, y, z]; numbers in JSON output read back to the same bits.
OrderedJson to_json(const Vec3& v);

/// How many ids there are, and the first hundred of them.
OrderedJson to_json(const std::vector<std::uint32_t>& ids);

/// What a pose spoils, with the hundred largest zones and some faces of each.
OrderedJson to_json(const bind::Distortion& distortion);

/// The same for a message: "2 % of the mesh: 3 triangle(s) folded, ...". Of at least one zone.
std::string describe(const bind::Distortion& distortion);

/// Writes the value and a line end to standard output.
void print(const OrderedJson& value);

const char* to_string(FrameStatus status);

}  // namespace tendril::runner
