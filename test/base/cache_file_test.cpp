#include "base/cache_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/bytes.h"
#include "base/worker_processes.h"

namespace microinjection {
namespace {

class CacheFileTest : public testing::Test {
 protected:
  CacheFileTest() {
    char name[] = "/tmp/cache_file_test.XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~CacheFileTest() override { std::filesystem::remove_all(folder_); }
  std::string folder_;
};

TEST_F(CacheFileTest, GivesBackWhatWasStoredForTheSameThingOnly) {
  const std::string path = folder_ + "/below/file", body("a\nb\0c", 5);
  EXPECT_EQ(readCacheFile(path, "thing").state, CacheState::kMissing);
  writeCacheFile(path, "thing", body);
  const CacheRead<std::string> read = readCacheFile(path, "thing");
  EXPECT_EQ(read.state, CacheState::kRead);
  EXPECT_EQ(read.content, body);
  const CacheRead<std::string> other = readCacheFile(path, "other");
  EXPECT_FALSE(other);
  EXPECT_EQ(other.state, CacheState::kOther);
  EXPECT_EQ(other.reason.find(path + ": "), 0u) << other.reason;
}

TEST_F(CacheFileTest, NoticesDamage) {
  const std::string path = folder_ + "/file";
  const auto expectDamage = [&](const std::string& what) {
    const CacheRead<std::string> read = readCacheFile(path, "thing");
    EXPECT_FALSE(read) << what;
    EXPECT_EQ(read.state, CacheState::kDamaged) << what;
    EXPECT_EQ(read.reason.find(path + ": is damaged: "), 0u) << read.reason;
  };
  writeCacheFile(path, "thing", "0123456789");
  const auto whole = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, whole - 1);
  expectDamage("torn");
  std::filesystem::resize_file(path, 8);
  expectDamage("torn in its header");
  std::filesystem::resize_file(path, 0);
  expectDamage("empty");
  writeCacheFile(path, "thing", "0123456789");
  std::fstream(path).seekp(-2, std::ios::end).write("x", 1);
  expectDamage("changed");
  std::ofstream(path) << "not of this cache\n0123456789";
  expectDamage("foreign");
}

/// A pipe that nobody writes to would be waited for.
TEST_F(CacheFileTest, ReadsRegularFilesOnlyAndDoesNotWait) {
  const std::string pipe = folder_ + "/pipe", loop = folder_ + "/loop";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(loop, loop);
  for (const std::string& path : {pipe, folder_, std::string("/dev/zero")}) {
    const CacheRead<std::string> read = readCacheFile(path, "thing");
    EXPECT_EQ(read.state, CacheState::kNotRegular) << path;
    EXPECT_EQ(read.reason, path + ": is not a regular file");
  }
  const CacheRead<std::string> endless = readCacheFile(loop, "thing");
  EXPECT_EQ(endless.state, CacheState::kUnreadable);
  EXPECT_EQ(endless.reason, loop + ": cannot be read: " + std::strerror(ELOOP));
  writeCacheFile(pipe, "thing", "body");
  EXPECT_EQ(readCacheFile(pipe, "thing").content, "body") << "it was not replaced";
}

TEST(Bytes, AreReadAsWrittenAndNoFurther) {
  ByteWriter writer;
  writer.number(1.5);
  writer.array(std::string("text"));
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.number<double>(), 1.5);
  std::string text;
  reader.array(text);
  EXPECT_EQ(text, "text");
  EXPECT_TRUE(reader.atEnd());
  EXPECT_THROW(reader.number<int>(), std::runtime_error);
}

TEST_F(CacheFileTest, WorkersRunEachCommandOnceAndTellItsStatus) {
  std::vector<std::vector<std::string>> commands;
  for (int i = 0; i < 7; ++i) commands.push_back({"/bin/sh", "-c", "exit " + std::to_string(i)});
  commands.push_back({"/bin/sh", "-c", "test \"$OPENBLAS_NUM_THREADS\" = 1 && kill -9 $$"});
  std::vector<int> statuses(8, -1);
  runWorkers(commands, 3, [&](std::size_t index, int status) { statuses[index] = status; });
  EXPECT_EQ(statuses, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 137}));
}

TEST_F(CacheFileTest, WorkersAreStoppedWhenOneFails) {
  const std::string mark = folder_ + "/mark";
  EXPECT_THROW(runWorkers({{"/bin/sh", "-c", "exit 1"}, {"/bin/sh", "-c", "sleep 2; touch " + mark}}, 2,
                          [](std::size_t, int) { throw std::runtime_error("stop"); }),
               std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(mark));
  EXPECT_THROW(runWorkers({{"/no/such/program"}}, 1, [](std::size_t, int) {}), std::runtime_error);
}

}  // namespace
}  // namespace microinjection
