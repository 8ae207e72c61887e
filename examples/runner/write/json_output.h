#pragma once

#include <tendril/base/number.h>
#include <tendril/base/types.h>
#include <tendril/bind/distortion.h>
#include <tendril/curve/frames.h>

#include <nlohmann/json.hpp>

namespace tendril::runner {

/// Keys stay in the order they were set.
using OrderedJson = nlohmann::ordered_json;

/// [x, y, z]; numbers in JSON output read back to the same bits.
OrderedJson to_json(const Vec3& v);

/// What a pose spoils, with the faces of each zone.
OrderedJson to_json(const bind::Distortion& distortion);

/// Writes the value and a line end to standard output.
void print(const OrderedJson& value);

const char* to_string(FrameStatus status);

}  // namespace tendril::runner
