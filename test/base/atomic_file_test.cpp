#include "base/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

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

}  // namespace
}  // namespace microinjection
