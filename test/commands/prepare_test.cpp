// The command as its users run it, as far as that takes no minutes.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/surrogate/surrogate_data.h"
#include "commands/run_tasks.h"

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

  static std::string surrogatePath() {
    const Scene scene = loadScene(kScene);
    return surrogateFile(scene, SurrogatePlan::plan(scene, SurrogateRange::standard(scene)));
  }

  /// The solved paths of all cells in the cache.
  std::vector<fs::path> storedPaths() const {
    std::vector<fs::path> result;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory_)) {
      if (entry.path().filename().string().rfind("path_", 0) == 0) result.push_back(entry.path());
    }
    return result;
  }

  bool said(const std::string& text) const { return said_.find(text) != std::string::npos; }

  const std::string directory_ = testing::TempDir() + "microinjection_prepare/",
                    scene_ = std::string("--scene ") + kScene;
  const std::string full_disk_ = "trap '' XFSZ; ulimit -f 0; ";
  std::string said_;
};

TEST_F(PrepareCommand, AFullDiskIsNoticedBeforeAPathIsSolved) {
  EXPECT_EQ(prepare(full_disk_, scene_), 2) << said_;
  EXPECT_TRUE(said(fs::path(surrogatePath()).parent_path().string())) << said_;
  EXPECT_TRUE(said("cannot be written: File too large")) << said_;
  EXPECT_FALSE(said("paths")) << said_;
}

TEST_F(PrepareCommand, AFolderThatCannotBeMadeIsNoticedBeforeAPathIsSolved) {
  EXPECT_EQ(prepare("XDG_CACHE_HOME=/dev/null ", scene_), 2) << said_;
  EXPECT_TRUE(said("/dev/null/cell_microinjection/surrogates/")) << said_;
  EXPECT_TRUE(said("cannot be written: Not a directory")) << said_;
  EXPECT_FALSE(said("paths")) << said_;
}

TEST_F(PrepareCommand, ADirectoryInThePlaceOfTheDataIsNoticedBeforeAPathIsSolved) {
  fs::create_directories(surrogatePath());
  EXPECT_EQ(prepare("", scene_), 2) << said_;
  EXPECT_TRUE(said(surrogatePath() + ": cannot be written: it is a directory; remove it")) << said_;
}

/// Ended before it solves by a disk that is full.
TEST_F(PrepareCommand, DamagedDataAreNamedAndMadeAnew) {
  writeCacheFile(surrogatePath(), "thing", "body");
  fs::resize_file(surrogatePath(), fs::file_size(surrogatePath()) - 1);
  EXPECT_EQ(prepare(full_disk_, scene_), 2) << said_;
  EXPECT_TRUE(said(surrogatePath() + ": is damaged: ")) << said_;
  EXPECT_TRUE(said("it is replaced")) << said_;
}

/// Two processes that make one family come to the same path at the same time.
TEST_F(PrepareCommand, APathOfAFamilyIsSolvedByOneOfTwoProcesses) {
  const std::string family = "--family " MICROINJECTION_SOURCE_DIR "/config/families/homogeneous.yaml ";
  const std::string path = family + "--at=1,1,0 --ray 40";
  const std::string other = "{ " MICROINJECTION_PREPARE " " + path + "; echo other $? >&2; } & ";
  const int first = prepare(other, path + "; here=$?; wait; (exit $here)");
  const std::size_t said_by_other = said_.find("other ");
  ASSERT_NE(said_by_other, std::string::npos) << said_;
  const int second = std::atoi(said_.c_str() + said_by_other + 6);
  for (const int status : {first, second}) EXPECT_TRUE(status == 0 || status == kBusyStatus) << said_;
  EXPECT_TRUE(first == 0 || second == 0) << said_;
  const std::vector<fs::path> solved = storedPaths();
  ASSERT_EQ(solved.size(), 1u);
  const auto written = fs::last_write_time(solved.front());
  EXPECT_EQ(prepare("", path), 0) << said_;
  EXPECT_EQ(fs::last_write_time(solved.front()), written);
}

/// Tasks of a family's next round, by number.
TEST_F(PrepareCommand, ATaskOfAPlanIsSolvedOnceAndGatheringNeedsAll) {
  fs::copy_file(MICROINJECTION_SOURCE_DIR "/config/families/homogeneous.yaml", directory_ + "family.yaml");
  const std::string family = "--family " + directory_ + "family.yaml ", plan = directory_ + "plan.csv";
  EXPECT_EQ(prepare("", family + "--members 1 --list " + plan), 0) << said_;
  std::ifstream file(plan);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  ASSERT_GT(lines.size(), 20u);
  EXPECT_EQ(lines[1], "task,kind,coordinates,piece");
  EXPECT_EQ(lines[2], "0,axis,,0");
  const std::size_t last = lines.size() - 3;  // its number
  EXPECT_EQ(lines.back().rfind(std::to_string(last) + ",path,", 0), 0u) << lines.back();

  const std::string task = family + "--plan " + plan + " --task " + std::to_string(last - 1) + " --count 9";
  EXPECT_EQ(prepare("", task), 0) << said_;
  const std::vector<fs::path> solved = storedPaths();
  ASSERT_EQ(solved.size(), 2u) << "up to the end of the plan";
  const auto written = fs::last_write_time(solved.front());
  EXPECT_EQ(prepare("", task), 0) << said_;
  EXPECT_EQ(fs::last_write_time(solved.front()), written);

  EXPECT_EQ(prepare("", family + "--members 1 --plan " + plan + " --gather"), 2);
  EXPECT_TRUE(said(std::to_string(last - 1) + " of " + std::to_string(last + 1) + " tasks are missing")) << said_;
  EXPECT_EQ(prepare("", family + "--plan " + plan + " --task " + std::to_string(last + 1)), 2);
  EXPECT_TRUE(said("must be below")) << said_;
  EXPECT_EQ(prepare("", family + "--plan " + plan), 2);
  EXPECT_TRUE(said("--plan needs one of --task and --gather")) << said_;
  std::ofstream(plan, std::ios::app) << "9,path,0 0 0,1\n";
  EXPECT_EQ(prepare("", family + "--plan " + plan + " --task 0"), 2);
  EXPECT_TRUE(said("is damaged, or of another family")) << said_;
}

TEST_F(PrepareCommand, ItsHelpNeedsAnOutput) {
  EXPECT_EQ(prepare("exec 3>/dev/full; ", "--help >&3"), 2) << said_;
  EXPECT_TRUE(said("prepare: the standard output: cannot be written: No space left")) << said_;
}

}  // namespace
}  // namespace microinjection
