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

  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "background_file_test";
  const std::string path = folder / "file.yaml";
};

TEST_F(BackgroundFileTest, HasTheNewestContentWhenItIsClosed) {
  {
    BackgroundFile file(path);
    for (int i = 0; i < 50; ++i) file.write(std::to_string(i));
  }
  EXPECT_EQ(content(), "49");
}

TEST_F(BackgroundFileTest, AtOnceEachContentIsThereWhenItIsWritten) {
  BackgroundFile file(path, BackgroundFile::Writing::kAtOnce);
  for (const char* text : {"1", "2"}) {
    file.write(text);
    EXPECT_EQ(content(), text);
  }
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  file.write("3");
  EXPECT_NE(file.error().find(path), std::string::npos);
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
