#include "whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

namespace tendril::posix {
namespace {

/// Owns one file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }

  int get() const { return fd_; }

  /// 0 or the error code. The descriptor is gone either way, also after EINTR.
  int close() {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd) == 0 || errno == EINTR ? 0 : errno;
  }

 private:
  int fd_;
};

/// Removes a file at the end of the scope unless it was released.
class Remover {
 public:
  explicit Remover(const std::string& path) : path_(path) {}
  Remover(const Remover&) = delete;
  Remover& operator=(const Remover&) = delete;
  ~Remover() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  void release() { path_.clear(); }

 private:
  std::string path_;
};

int open_retrying(const std::string& path, int flags, mode_t mode = 0) {
  int fd = -1;
  do {
    fd = ::open(path.c_str(), flags | O_CLOEXEC, mode);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

/// 0 or the error code.
int write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

/// A name in the target's folder that no other file has, and its open descriptor.
int create_beside(const std::string& target, std::string& name) {
  for (int attempt = 0;; ++attempt) {
    name = target + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    const int fd = open_retrying(name, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd >= 0 || errno != EEXIST || attempt == 1000) return fd;
  }
}

/// The file a symbolic link leads to, so that the link itself survives the rename.
/// \return  0 or the error code
int resolve(const std::string& path, std::string& target) {
  target = path;
  std::error_code ignored;
  if (!std::filesystem::is_symlink(path, ignored)) return 0;
  std::error_code code;
  const auto end = std::filesystem::weakly_canonical(path, code);
  if (!code) target = end.string();
  return code.value();
}

/// 0, EISDIR or kNotRegular.
int require_regular(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return EISDIR;
  return S_ISREG(status.st_mode) ? 0 : kNotRegular;
}

/// Makes the rename itself durable. Its failure is not an error: the file is whole under its name already.
void flush_folder(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  const Descriptor fd(open_retrying(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY));
  if (fd.get() >= 0) ::fsync(fd.get());
}

}  // namespace

int read_whole(const std::string& path, std::string& bytes) {
  // Non-blocking, so that a pipe without a writer is refused below instead of waited for.
  const Descriptor fd(open_retrying(path, O_RDONLY | O_NONBLOCK));
  if (fd.get() < 0) return errno;
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) return errno;
  if (const int code = require_regular(status)) return code;

  // One byte more, so that the end shows without growing.
  bytes.assign(static_cast<std::size_t>(status.st_size) + 1, '\0');
  std::size_t filled = 0;
  for (;;) {
    if (filled == bytes.size()) bytes.resize(bytes.size() + 4096);  // the file grew meanwhile
    const ssize_t n = ::read(fd.get(), bytes.data() + filled, bytes.size() - filled);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) break;
    filled += static_cast<std::size_t>(n);
  }
  bytes.resize(filled);
  return 0;
}

int write_whole(const std::string& path, std::string_view bytes) {
  std::string target;
  if (const int code = resolve(path, target)) return code;
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists)
    if (const int code = require_regular(old)) return code;

  std::string part;
  Descriptor fd(create_beside(target, part));
  if (fd.get() < 0) return errno;
  Remover remover(part);
  if (exists && ::fchmod(fd.get(), old.st_mode & 07777) != 0) return errno;
  if (const int code = write_all(fd.get(), bytes)) return code;
  if (::fsync(fd.get()) != 0) return errno;
  if (const int code = fd.close()) return code;
  if (::rename(part.c_str(), target.c_str()) != 0) return errno;
  remover.release();
  flush_folder(target);
  return 0;
}

}  // namespace tendril::posix
