#pragma once

#include <tendril/base/export.h>

/// The version of these headers, for `#if`: numbers without leading zeros, as CMake's project() has them.
#define TENDRIL_VERSION_MAJOR 0
#define TENDRIL_VERSION_MINOR 1
#define TENDRIL_VERSION_PATCH 0

namespace tendril {

/// The version of the library that the program runs with, "major.minor.patch"; another than that of the
/// headers only where a shared library was exchanged. Versions that share major and minor number have the
/// same binary interface, which the name of the shared library says (its soname ends with them).
TENDRIL_CORE_API const char* version();

}  // namespace tendril
