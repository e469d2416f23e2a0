#include "operation/record/injection_notebook.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace microinjection {
namespace {

std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

class InjectionNotebook : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("notebook_") + test.name());
    std::filesystem::remove_all(folder_);
    path_ = (folder_ / "deep" / "notebook.csv").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  std::string path_;
};

TEST_F(InjectionNotebook, HasALineForEachEntryBelowTheHeader) {
  NotebookEntry entry;
  entry.time = "2026-11-25T10:00:00";
  entry.cell = "mouse_oocyte";
  entry.modulus = NotebookEntry::Estimate{17900, 17000, 18800};
  entry.outcome = "injected";
  appendToNotebook(path_, entry);
  entry.punctures = 1;
  entry.puncture_force = 1.5e-6;
  appendToNotebook(path_, entry);
  EXPECT_EQ(contentOf(path_),
            std::string(kNotebookHeader) +
                "2026-11-25T10:00:00,mouse_oocyte,,17900,17000,18800,,,,,,,,,,0,0,0,0,injected,\n"
                "2026-11-25T10:00:00,mouse_oocyte,,17900,17000,18800,,,,,,,,,1.5e-06,0,0,1,0,injected,\n");
}

TEST_F(InjectionNotebook, EveryLineHasTheColumnsOfTheHeader) {
  NotebookEntry entry;
  entry.diameter = 56e-6;
  entry.expected_depth = entry.expected_force = NotebookEntry::Estimate{1, 2, 3};
  const std::string line = toLine(entry), header = kNotebookHeader;
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ','));
}

TEST_F(InjectionNotebook, TextsStayInTheirColumnAndLine) {
  NotebookEntry entry;
  entry.reason = "the \"needle\", it\nbroke";
  const std::string line = toLine(entry);
  EXPECT_NE(line.find(",\"the \"\"needle\"\", it broke\"\n"), std::string::npos) << line;
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
}

TEST_F(InjectionNotebook, WhatIsNoNotebookStaysAsItIs) {
  std::filesystem::create_directories(folder_ / "deep");
  std::ofstream(path_) << "a letter\n";
  EXPECT_THROW(appendToNotebook(path_, {}), std::runtime_error);
  EXPECT_EQ(contentOf(path_), "a letter\n");
}

TEST_F(InjectionNotebook, ALastLineThatWasCutIsClosed) {
  std::filesystem::create_directories(folder_ / "deep");
  std::ofstream(path_) << kNotebookHeader << "2026-11-25,cut";
  appendToNotebook(path_, {});
  EXPECT_NE(contentOf(path_).find("2026-11-25,cut\n,"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
