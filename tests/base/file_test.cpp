#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

namespace tendril {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  Files() : folder_(fs::path(testing::TempDir()) / ("tendril-files-" + std::to_string(::getpid()))) {
    fs::create_directory(folder_);
  }
  ~Files() override { fs::remove_all(folder_); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

 private:
  fs::path folder_;
};

/// what() of the FileError that `call` throws.
template <class Call>
std::string file_error(Call&& call) {
  try {
    call();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no FileError";
}

TEST_F(Files, KeepEveryByte) {
  std::string bytes;
  for (int i = 0; i < 100000; ++i) bytes += static_cast<char>(i * 7 % 256);
  for (const std::string& content : {bytes, std::string(), std::string("a\r\nb\0c", 6)}) {
    write_file_whole(file("data"), content);
    EXPECT_EQ(read_file(file("data")), content);
  }
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, ReadNamesTheSystemsReason) {
  EXPECT_EQ(file_error([&] { read_file(file("none")); }), file("none") + ": No such file or directory");
  EXPECT_EQ(file_error([&] { read_file(file("")); }), file("") + ": Is a directory");
  EXPECT_EQ(file_error([&] { read_file("/dev/zero"); }), "/dev/zero: not a regular file");
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(file_error([&] { read_file(file("pipe")); }), file("pipe") + ": not a regular file");
}

TEST_F(Files, WriteRefusesWhatIsNoRegularFile) {
  fs::create_directory(file("folder"));
  EXPECT_EQ(file_error([&] { write_file_whole(file("folder"), "x"); }), file("folder") + ": Is a directory");
  EXPECT_EQ(file_error([&] { write_file_whole("/dev/null", "x"); }), "/dev/null: not a regular file");
  EXPECT_EQ(file_error([&] { write_file_whole(file("none/a"), "x"); }),
            file("none/a") + ": No such file or directory");
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, WriteFollowsALinkAndKeepsPermissions) {
  write_file_whole(file("target"), "old");
  fs::permissions(file("target"), fs::perms(0640));
  fs::create_symlink("target", file("link"));
  write_file_whole(file("link"), "new");
  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_EQ(read_file(file("target")), "new");
  EXPECT_EQ(fs::status(file("target")).permissions(), fs::perms(0640));
}

/// Writing beyond a file-size limit fails as a full disk does, half-way through the bytes.
TEST_F(Files, AFailedWriteLeavesTheOldFileAlone) {
  write_file_whole(file("data"), "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit tight{4096, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const std::string what = file_error([&] { write_file_whole(file("data"), std::string(100000, 'x')); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(what, file("data") + ": File too large");
  EXPECT_EQ(read_file(file("data")), "old");
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace tendril
