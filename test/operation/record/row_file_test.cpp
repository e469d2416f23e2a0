#include "operation/record/row_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace microinjection {
namespace {

constexpr char kHeader[] = "a,b\n";

class RowFileTest : public testing::Test {
 protected:
  RowFileTest() {
    std::filesystem::remove_all(folder_);
    std::signal(SIGXFSZ, SIG_IGN);  // a full disk is a reply here, not a signal
  }
  ~RowFileTest() override {
    space(RLIM_INFINITY);
    std::filesystem::remove_all(folder_);
  }

  /// Files of this program get no larger than that.
  static void space(rlim_t bytes) {
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = std::min(bytes, limit.rlim_max);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  }

  std::string content(const std::string& path) const {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  std::string active() const { return content(path_ + ".active"); }

  const std::string folder_ = testing::TempDir() + "row_file_test";
  const std::string path_ = folder_ + "/deep/table.csv";
};

TEST_F(RowFileTest, RowsAreThereBeforeTheEndAndTheNameComesWithIt) {
  RowFile file(path_, kHeader);
  EXPECT_EQ(active(), "a,b\n");
  file.append("1,2\n");
  file.flush();
  EXPECT_EQ(active(), "a,b\n1,2\n");
  file.append("3,4\n");
  file.append("5,6\n");
  file.flush();
  EXPECT_EQ(active(), "a,b\n1,2\n3,4\n5,6\n");
  EXPECT_FALSE(std::filesystem::exists(path_));
  file.append("7,8\n");
  EXPECT_EQ(file.finish(), "");
  EXPECT_EQ(content(path_), "a,b\n1,2\n3,4\n5,6\n7,8\n");
  EXPECT_FALSE(std::filesystem::exists(path_ + ".active"));
  EXPECT_EQ(file.written(), 4u);
  EXPECT_EQ(file.finish(), "") << "once more";
}

TEST_F(RowFileTest, WithoutItsEndTheRowsStayUnderTheOtherName) {
  {
    RowFile file(path_, kHeader);
    file.append("1,2\n");
  }
  EXPECT_EQ(active(), "a,b\n1,2\n");
  EXPECT_FALSE(std::filesystem::exists(path_));
  RowFile next(path_, kHeader);
  EXPECT_EQ(active(), "a,b\n") << "of the session before nothing is mixed in";
}

TEST_F(RowFileTest, AFullDiskCostsRowsAndIsSaidAsLongAsItLasts) {
  RowFile file(path_, kHeader);
  file.append("1,2\n");
  file.flush();
  space(18);
  file.append("3,4\n");
  file.append("5,6\n");
  file.append("7,8\n");  // the last bytes of this one have no space
  file.flush();
  EXPECT_EQ(active(), "a,b\n1,2\n3,4\n5,6\n");
  EXPECT_EQ(file.errorText(), path_ + ".active: cannot be written: File too large");
  EXPECT_EQ(file.lost(), 1u);
  for (int i = 0; i < 3; ++i) {
    file.append("9,9\n");
    file.flush();
    EXPECT_NE(file.errorText(), "");
  }
  EXPECT_EQ(file.lost(), 4u);
  space(RLIM_INFINITY);
  file.append("0,1\n");
  file.flush();
  EXPECT_EQ(file.errorText(), "");
  EXPECT_EQ(file.finish(), path_ + ": 4 rows are lost: File too large");
  EXPECT_EQ(content(path_), "a,b\n1,2\n3,4\n5,6\n0,1\n");
  EXPECT_EQ(file.written(), 4u);
}

TEST_F(RowFileTest, WithoutSpaceAtTheStartTheHeaderComesWithTheFirstRowThatHasIt) {
  space(2);
  RowFile file(path_, kHeader);
  EXPECT_NE(file.errorText().find(path_), std::string::npos);
  file.append("1,2\n");
  file.flush();
  EXPECT_EQ(active(), "");
  EXPECT_EQ(file.lost(), 1u);
  space(RLIM_INFINITY);
  file.append("3,4\n");
  file.flush();
  EXPECT_EQ(active(), "a,b\n3,4\n");
  EXPECT_EQ(file.written(), 1u);
}

TEST_F(RowFileTest, WhatNeverHadSpaceIsNoTable) {
  std::filesystem::create_directories(folder_ + "/deep");
  std::filesystem::create_symlink("/dev/full", path_ + ".active");
  RowFile file(path_, kHeader);
  file.append("1,2\n");
  const std::string error = file.finish();
  EXPECT_EQ(error,
            path_ + ".active: cannot be written: No space left on device; 1 rows are lost, and there is no table");
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(RowFileTest, AFolderThatCannotBeIsSaid) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ + "/deep") << "a file";
  try {
    RowFile file(path_, kHeader);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path_ + ".active: cannot be written: "), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
