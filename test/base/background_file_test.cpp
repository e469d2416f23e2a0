#include "base/background_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace microinjection {
namespace {

class BackgroundFileTest : public ::testing::Test {
 protected:
  BackgroundFileTest() { std::filesystem::create_directories(folder); }
  ~BackgroundFileTest() override { std::filesystem::remove_all(folder); }

  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "background_file_test";
  const std::string path = folder / "file.yaml";
};

TEST_F(BackgroundFileTest, HasTheNewestContentWhenItIsClosed) {
  {
    BackgroundFile file(path);
    for (int i = 0; i < 50; ++i) file.write(std::to_string(i));
  }
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  EXPECT_EQ(content.str(), "49");
}

TEST_F(BackgroundFileTest, ReportsWhyItCannotBeWritten) {
  std::filesystem::create_directory(path);
  BackgroundFile file(path);
  EXPECT_EQ(file.error(), "");
  file.write("1");
  while (file.error().empty()) std::this_thread::yield();
  EXPECT_NE(file.error().find(path), std::string::npos);
}

TEST_F(BackgroundFileTest, IsNotMadeWithoutContent) {
  { BackgroundFile file(path); }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace microinjection
