#pragma once

#include <tendril/dynamics/system.h>

namespace tendril {

/// The library's own way to the flat arrays behind a System, which are no part of its interface.
struct SystemAccess {
  using Model = System::Model;
  static const Model& model(const System& system) { return *system.model_; }
};

using Model = SystemAccess::Model;

inline const Model& model_of(const System& system) {
  return SystemAccess::model(system);
}

}  // namespace tendril
