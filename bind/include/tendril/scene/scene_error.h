#pragma once

#include <tendril/base/error.h>
#include <tendril/base/export.h>

#include <string>

namespace tendril::scene {

/// Where in a scene or curve file something stands.
struct FilePlace {
  std::string file;        ///< as it was given to the reader
  std::string pointer;     ///< JSON pointer (RFC 6901); empty for the whole document, and where it is no JSON
  std::size_t line = 0;    ///< from 1; 0 where it is not known
  std::size_t column = 0;  ///< from 1; only where the file is no JSON: then `pointer` is empty
};

/// A scene or curve file that cannot be used. place() is "file:line:column" where the file is no JSON, else
/// "file#/pointer"; reason() quotes the value found, expected() says what would have been right.
class TENDRIL_SCENE_API SceneError : public InvalidInput {
 public:
  /// \param at        the place
  /// \param reason    what is wrong, with the value found
  /// \param expected  what would have been right
  SceneError(FilePlace at, const std::string& reason, const std::string& expected);

  /// place() in parts.
  const FilePlace& at() const { return at_; }

 private:
  FilePlace at_;
};

}  // namespace tendril::scene
