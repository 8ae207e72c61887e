#pragma once

#include <tendril/scene/scene_error.h>

#include <string>
#include <string_view>

namespace tendril::scene {

/// The line, from 1, on which the value (in an object: its key) that a JSON pointer names begins in a text;
/// that of the value around it where there is none. 0 where the text is no JSON.
std::size_t line_of(std::string_view text, const std::string& pointer);

/// The error with the line of its place, where it has none yet.
/// \param text  of the file that it is about
SceneError with_line(const SceneError& error, std::string_view text);

/// Runs f, a reader of a text; its errors get their line.
template <class F>
auto with_lines(std::string_view text, F&& f) {
  try {
    return f();
  } catch (const SceneError& error) {
    throw with_line(error, text);
  }
}

}  // namespace tendril::scene
