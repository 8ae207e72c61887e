#pragma once

#include <tendril/base/error.h>
#include <tendril/bind/bind_options.h>

#include <CLI/CLI.hpp>

namespace tendril::runner {

/// How a mesh is bound, alike in every command that binds one: continuously, or with --nearest.
struct ModeFlags {
  bool nearest = false, continuous = false;

  void add_to(CLI::App& app) {
    app.add_flag("--nearest", nearest,
                 "bind each point to its nearest projection alone: tears where that jumps");
    app.add_flag("--continuous", continuous, "bind without tears: what happens anyway");
  }
  bind::BindMode mode() const {
    if (nearest && continuous) throw InvalidInput("--nearest", "with --continuous", "one of the two");
    return nearest ? bind::BindMode::nearest : bind::BindMode::continuous;
  }
};

}  // namespace tendril::runner
