#include <tendril/base/error.h>
#include <tendril/dynamics/method.h>

#include <algorithm>
#include <string>

#include "method_row.h"

namespace tendril {
namespace {

/// Those with an enumerator in the order of the enumeration, then the others by name, numbered on.
std::vector<MethodInfo> table() {
  std::vector<MethodInfo> rows = rows_of_files();
  std::stable_sort(rows.begin(), rows.end(), [](const MethodInfo& a, const MethodInfo& b) {
    return static_cast<unsigned>(a.method) < static_cast<unsigned>(b.method);
  });
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].method = static_cast<Method>(i);
  return rows;
}

}  // namespace

std::span<const MethodInfo> methods() {
  static const std::vector<MethodInfo> rows = table();
  return rows;
}

const MethodInfo& info(Method method) {
  const auto rows = methods();
  const auto number = static_cast<std::size_t>(method);
  if (number < rows.size()) return rows[number];
  throw InvalidInput("method", "number " + std::to_string(static_cast<int>(method)),
                     "an enumerator, or what find_method gives");
}

const MethodInfo* find_method(std::string_view name) {
  const auto rows = methods();
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const MethodInfo& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

const char* to_string(Method method) {
  return info(method).name;
}

bool chooses_steps(Method method) {
  return info(method).chooses != Chooses::nothing;
}

std::unique_ptr<Stepper> make_stepper(Method method, const System& system) {
  return info(method).make(system);
}

}  // namespace tendril
