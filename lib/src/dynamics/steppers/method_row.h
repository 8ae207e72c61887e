#pragma once

#include <tendril/dynamics/method.h>

#include <limits>
#include <memory>
#include <vector>

// A method of the library is one file of lib/src/dynamics/methods. The file x.cpp defines
//   MethodInfo x_method();
// in this namespace: its row in the table, and with it the stepper unless a header has that. What else names
// methods goes through the table.
namespace tendril {

/// In the row of a method without an enumerator: the table gives it a number.
constexpr Method kUnnumbered{-1};

/// Of a limit of stability: there is none.
constexpr double kAnyStep = std::numeric_limits<double>::infinity();

/// A row's maker.
template <class S>
std::unique_ptr<Stepper> made(const System& system) {
  return std::make_unique<S>(system);
}

/// The rows of all files, by the files' names.
std::vector<MethodInfo> rows_of_files();

}  // namespace tendril
