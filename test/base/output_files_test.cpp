#include "base/output_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

class OutputFilesTest : public testing::Test {
 protected:
  OutputFilesTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "images");
    for (const char* name : {"scene.yaml", "images/cell.png"}) std::ofstream(folder_ / name) << name;
  }
  ~OutputFilesTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string refusal(const OutputFiles& files) {
    try {
      files.check();
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }

  const std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "output_files_test";
};

TEST_F(OutputFilesTest, AnOutputThatIsAnInputIsRefusedByWhateverWay) {
  std::filesystem::create_symlink(path("scene.yaml"), path("link.yaml"));
  std::filesystem::create_hard_link(path("scene.yaml"), path("same.yaml"));
  for (const char* name : {"scene.yaml", "images/../scene.yaml", "link.yaml", "same.yaml"}) {
    const std::string refused = refusal(OutputFiles().reads("--scene", path("scene.yaml")).writes("--csv", path(name)));
    EXPECT_EQ(refused, "--csv = " + path(name) + ": must be another file than --scene, which is read");
  }
}

TEST_F(OutputFilesTest, AFileOfAFolderThatIsReadIsRefusedANewOneIsNot) {
  const auto written = [&](const std::string& name) {
    return refusal(OutputFiles().reads("INPUT", path("images")).writes("--overlay", path(name)));
  };
  EXPECT_NE(written("images/cell.png").find("those of INPUT"), std::string::npos);
  EXPECT_EQ(written("images/overlay.png"), "");
}

TEST_F(OutputFilesTest, TwoOutputsAreTwoFiles) {
  const std::string refused =
      refusal(OutputFiles().writes("--csv", path("new.csv")).writes("--residuals", path("images/../new.csv")));
  EXPECT_NE(refused.find("--residuals = "), std::string::npos) << refused;
  EXPECT_NE(refused.find("than --csv, which is written, too"), std::string::npos) << refused;
}

TEST_F(OutputFilesTest, WhatCannotBeWrittenIsKnownBefore) {
  EXPECT_NE(refusal(OutputFiles().writes("--csv", path("images"))).find("is a folder"), std::string::npos);
  const std::string below_a_file = path("scene.yaml/x.csv");
  EXPECT_EQ(refusal(OutputFiles().writes("--csv", below_a_file)).find(below_a_file + ": cannot be written: "), 0U);
  EXPECT_EQ(refusal(OutputFiles().writes("--csv", "/dev/null")), "");
}

TEST_F(OutputFilesTest, NothingIsChangedAndNoneIsNone) {
  EXPECT_EQ(refusal(OutputFiles()
                        .reads("--scene", path("scene.yaml"))
                        .writes("--csv", "-")
                        .writes("--out", "")
                        .writes("--table", path("new/table.csv"))),
            "");
  EXPECT_TRUE(std::filesystem::is_directory(path("new")));
  EXPECT_TRUE(std::filesystem::is_empty(path("new")));
  EXPECT_GT(std::filesystem::file_size(path("scene.yaml")), 0U);
}

}  // namespace
}  // namespace microinjection
