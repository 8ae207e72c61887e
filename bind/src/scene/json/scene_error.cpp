#include <tendril/scene/scene_error.h>

namespace tendril::scene {
namespace {

std::string text_of(const FilePlace& at) {
  if (at.column == 0) return at.file + "#" + at.pointer;
  return at.file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}

}  // namespace

SceneError::SceneError(FilePlace at, const std::string& reason, const std::string& expected)
    : InvalidInput(text_of(at), reason, expected), at_(std::move(at)) {}

}  // namespace tendril::scene
