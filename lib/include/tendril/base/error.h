#pragma once

#include <tendril/base/export.h>

#include <stdexcept>
#include <string>

/// Errors are of two kinds. Bad input throws one of the exceptions below, before anything is changed or
/// written. A numerical outcome (not converged, degenerate, too stiff) is never thrown: it is a status in the
/// result.
namespace tendril {

/// Base of everything the library throws on purpose.
class TENDRIL_CORE_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller's data cannot be used.
class TENDRIL_CORE_API InvalidInput : public Error {
 public:
  /// \param place     what the fault is in: "mesh.off:12", "scene.json#/curves/0/degree", "BSpline: knots[4]"
  /// \param reason    what is wrong, with the value found
  /// \param expected  what would have been right
  InvalidInput(const std::string& place, const std::string& reason, const std::string& expected);

  const std::string& place() const { return place_; }        ///< as given to the constructor
  const std::string& reason() const { return reason_; }      ///< as given to the constructor
  const std::string& expected() const { return expected_; }  ///< as given to the constructor

 private:
  std::string place_, reason_, expected_;
};

/// A file cannot be opened, read or written; what() holds its name and the system's reason.
class TENDRIL_CORE_API FileError : public Error {
 public:
  /// \param path    the file's name, as the caller gave it
  /// \param reason  the system's reason, or what kind of file it is
  FileError(const std::string& path, const std::string& reason);

  const std::string& path() const { return path_; }  ///< as given to the constructor

 private:
  std::string path_;
};

}  // namespace tendril
