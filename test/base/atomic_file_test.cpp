#include "base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "base/errors.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(directory_); }
  void TearDown() override { fs::remove_all(directory_); }

  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  const std::string directory_ = testing::TempDir() + "microinjection_atomic_file";
};

TEST_F(AtomicFile, MakesDirectoriesAndReplacesAndLeavesNothingElse) {
  const std::string path = directory_ + "/a/b/file";
  writeFileAtomically(path, std::string("one\0two", 7));
  EXPECT_EQ(read(path), std::string("one\0two", 7));
  writeFileAtomically(path, "three");
  EXPECT_EQ(read(path), "three");
  const auto count = std::distance(fs::directory_iterator(directory_ + "/a/b"), fs::directory_iterator());
  EXPECT_EQ(count, 1);
}

TEST_F(AtomicFile, NamesThePathThatItCannotWrite) {
  fs::create_directories(directory_ + "/taken");
  try {
    writeFileAtomically(directory_ + "/taken", "x");  // a directory is in the way
    FAIL() << "wrote over a directory";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(directory_ + "/taken"), std::string::npos);
  }
  const auto count = std::distance(fs::directory_iterator(directory_), fs::directory_iterator());
  EXPECT_EQ(count, 1) << "the temporary file was left behind";
  std::ofstream(directory_ + "/file") << "x";
  EXPECT_THROW(writeFileAtomically(directory_ + "/file/below", "x"), std::runtime_error);
}

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const WriteError& error) {
    return error.what();
  }
  return "";
}

TEST_F(AtomicFile, WritesToADeviceAndGivesTheSystemsReason) {
  EXPECT_NO_THROW(writeFileAtomically("/dev/null", "x"));
  EXPECT_EQ(messageOf([] { writeFileAtomically("/dev/full", "x"); }),
            std::string("/dev/full: cannot be written: ") + std::strerror(ENOSPC));
}

/// A pipe that nobody reads would be waited for.
TEST_F(AtomicFile, ReplacesAPipeWhereAFileBelongs) {
  fs::create_directories(directory_);
  const std::string path = directory_ + "/pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  replaceFileAtomically(path, "content");
  EXPECT_TRUE(fs::is_regular_file(path));
  EXPECT_EQ(read(path), "content");
}

TEST_F(AtomicFile, TriesAFolderAndLeavesNothingInIt) {
  requireWritableFolder(directory_ + "/a/b");
  EXPECT_TRUE(fs::is_empty(directory_ + "/a/b"));
  EXPECT_EQ(messageOf([] { requireWritableFolder("/dev/null/below"); }),
            std::string("/dev/null/below: cannot be written: ") + std::strerror(ENOTDIR));
}

/// No file may grow, as on a full disk: in a process of its own, because the limit stays.
TEST_F(AtomicFile, AFullDiskIsNoticedByTrying) {
  fs::create_directories(directory_);
  const auto tryIt = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit nothing{0, 0};
    setrlimit(RLIMIT_FSIZE, &nothing);
    const std::string message = messageOf([&] { requireWritableFolder(directory_); });
    const bool named = message.find(directory_) == 0 && message.find(std::strerror(EFBIG)) != std::string::npos;
    _exit(named && fs::is_empty(directory_) ? 7 : 1);
  };
  EXPECT_EXIT(tryIt(), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace microinjection
