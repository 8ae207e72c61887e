#pragma once

#include <tendril/base/export.h>

#include <string>

namespace tendril {

/// The shortest text that reads back to the same double, whatever the locale: "0.1", "1e+30", "inf", "nan".
TENDRIL_CORE_API std::string shortest(double value);

}  // namespace tendril
