// The command as its users run it, as far as that takes no minutes.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/cache_file.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";

/// With a cache of its own.
class PrepareCommand : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(directory_);
    fs::create_directories(directory_);
    setenv("XDG_CACHE_HOME", directory_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("XDG_CACHE_HOME");
    fs::remove_all(directory_);
  }

  /// Exit status; `before` is of the shell. What it says goes through a pipe, because no file may grow in some tests.
  int prepare(const std::string& before, const std::string& arguments) {
    const std::string call = before + "timeout 60 " MICROINJECTION_PREPARE " " + arguments + "; echo status $? >&2";
    const std::string command = "{ (" + call + ") 2>&1 >/dev/null; } | cat >" + directory_ + "said.txt";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ostringstream text;
    text << std::ifstream(directory_ + "said.txt").rdbuf();
    said_ = text.str();
    const std::size_t status = said_.rfind("status ");
    return status == std::string::npos ? -1 : std::atoi(said_.c_str() + status + 7);
  }

  static std::string preparedPath() {
    const Scene scene = loadScene(kScene);
    return preparedFile(scene, Preparation::plan(scene, PreparationRange::standard(scene)));
  }

  bool said(const std::string& text) const { return said_.find(text) != std::string::npos; }

  const std::string directory_ = testing::TempDir() + "microinjection_prepare/",
                    scene_ = std::string("--scene ") + kScene;
  const std::string full_disk_ = "trap '' XFSZ; ulimit -f 0; ";
  std::string said_;
};

TEST_F(PrepareCommand, AFullDiskIsNoticedBeforeAPathIsSolved) {
  EXPECT_EQ(prepare(full_disk_, scene_), 2) << said_;
  EXPECT_TRUE(said(fs::path(preparedPath()).parent_path().string())) << said_;
  EXPECT_TRUE(said("cannot be written: File too large")) << said_;
  EXPECT_FALSE(said("paths")) << said_;
}

TEST_F(PrepareCommand, AFolderThatCannotBeMadeIsNoticedBeforeAPathIsSolved) {
  EXPECT_EQ(prepare("XDG_CACHE_HOME=/dev/null ", scene_), 2) << said_;
  EXPECT_TRUE(said("/dev/null/cell_microinjection/prepared/")) << said_;
  EXPECT_TRUE(said("cannot be written: Not a directory")) << said_;
  EXPECT_FALSE(said("paths")) << said_;
}

TEST_F(PrepareCommand, ADirectoryInThePlaceOfTheDataIsNoticedBeforeAPathIsSolved) {
  fs::create_directories(preparedPath());
  EXPECT_EQ(prepare("", scene_), 2) << said_;
  EXPECT_TRUE(said(preparedPath() + ": cannot be written: it is a directory; remove it")) << said_;
}

/// Ended before it solves by a disk that is full.
TEST_F(PrepareCommand, DamagedDataAreNamedAndMadeAnew) {
  writeCacheFile(preparedPath(), "thing", "body");
  fs::resize_file(preparedPath(), fs::file_size(preparedPath()) - 1);
  EXPECT_EQ(prepare(full_disk_, scene_), 2) << said_;
  EXPECT_TRUE(said(preparedPath() + ": is damaged: ")) << said_;
  EXPECT_TRUE(said("it is replaced")) << said_;
}

TEST_F(PrepareCommand, ItsHelpNeedsAnOutput) {
  EXPECT_EQ(prepare("exec 3>/dev/full; ", "--help >&3"), 2) << said_;
  EXPECT_TRUE(said("prepare: the standard output: cannot be written: No space left")) << said_;
}

}  // namespace
}  // namespace microinjection
