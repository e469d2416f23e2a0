#include "vision/camera/video_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/errors.h"
#include "vision/camera/video_source.h"

namespace microinjection {
namespace {

class VideoFileTest : public testing::Test {
 protected:
  VideoFileTest() { std::filesystem::create_directories(folder_); }
  ~VideoFileTest() override { std::filesystem::remove_all(folder_); }

  static cv::Mat frame(int level, int type = CV_8UC1) { return {48, 64, type, cv::Scalar::all(level)}; }

  const std::string folder_ = testing::TempDir() + "microinjection_video_file";
  const std::string path_ = folder_ + "/overlay.avi";
};

TEST_F(VideoFileTest, IsReadAsItWasWritten) {
  {
    VideoFile file(path_, 25);
    file.write(frame(40), 10.5);
    file.write(frame(120, CV_8UC3), 10.75);
    EXPECT_EQ(file.frames(), 2);
  }
  VideoSource source(path_, 0, false);
  EXPECT_NEAR(source.period(), 0.04, 1e-3);
  for (const int level : {40, 120}) {
    const auto read = source.next();
    ASSERT_TRUE(read);
    EXPECT_NEAR(cv::mean(read->image)[0], level, 3);
  }
  EXPECT_FALSE(source.next());
  std::ostringstream times;
  times << std::ifstream(path_ + ".csv").rdbuf();
  EXPECT_EQ(times.str(), "frame,stamp\n0,10.500000\n1,10.750000\n");
}

TEST_F(VideoFileTest, RefusesWhatDoesNotFit) {
  VideoFile file(path_, 25);
  EXPECT_THROW(file.write(frame(40, CV_16UC1), 0), ConfigError);
  file.write(frame(40), 0);
  EXPECT_THROW(file.write(cv::Mat(10, 10, CV_8UC1), 1), ConfigError);
  EXPECT_EQ(file.frames(), 1);
}

TEST_F(VideoFileTest, AFolderThatIsNotThereIsNamed) {
  VideoFile file("/nowhere/overlay.avi", 25);
  try {
    file.write(frame(40), 0);
    FAIL();
  } catch (const WriteError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
