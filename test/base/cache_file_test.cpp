#include "base/cache_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
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
  EXPECT_FALSE(readCacheFile(path, "thing"));
  writeCacheFile(path, "thing", body);
  EXPECT_EQ(readCacheFile(path, "thing"), body);
  EXPECT_FALSE(readCacheFile(path, "other"));
}

TEST_F(CacheFileTest, NoticesDamage) {
  const std::string path = folder_ + "/file";
  writeCacheFile(path, "thing", "0123456789");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_FALSE(readCacheFile(path, "thing"));
  writeCacheFile(path, "thing", "0123456789");
  std::fstream(path).seekp(-2, std::ios::end).write("x", 1);
  EXPECT_FALSE(readCacheFile(path, "thing"));
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
