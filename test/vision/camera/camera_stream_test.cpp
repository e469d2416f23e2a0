#include "vision/camera/camera_stream.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>

#include "base/errors.h"

namespace microinjection {
namespace {

/// Delivers images of one level each; a negative level is a device that fails.
class LevelSource : public FrameSource {
 public:
  LevelSource(std::deque<int>& levels, double period) : levels_(levels), period_(period) {}
  std::optional<CameraFrame> next() override {
    if (levels_.empty()) return std::nullopt;
    const int level = levels_.front();
    levels_.pop_front();
    if (level < 0) {
      report("fails");
      return std::nullopt;
    }
    return CameraFrame{cv::Mat(3, 4, CV_8U, cv::Scalar(level)), std::nullopt, std::to_string(level)};
  }
  double period() const override { return period_; }

 private:
  std::deque<int>& levels_;
  double period_;
};

CameraStream streamOf(std::deque<int>& levels, const std::string& source) {
  FrameSourceConfig config;
  config.source = source;
  return {config, [&levels, source] { return std::make_unique<LevelSource>(levels, source == "device" ? 0 : 0.1); }};
}

TEST(CameraStream, DropsWhatAStoppedDeviceRepeats) {
  std::deque<int> levels = {1, 2, 2, 2, 3};
  CameraStream stream(streamOf(levels, "device"));
  EXPECT_TRUE(stream.next());
  EXPECT_TRUE(stream.next());
  EXPECT_FALSE(stream.next());
  EXPECT_FALSE(stream.next());
  EXPECT_EQ(stream.next()->name, "3");
  EXPECT_EQ(stream.state().repeated, 2U);
  EXPECT_EQ(stream.state().frames, 3U);
  EXPECT_FALSE(stream.state().ended);
}

TEST(CameraStream, OpensADeviceAgain) {
  std::deque<int> levels = {1, -1, 4};
  CameraStream stream(streamOf(levels, "device"));
  EXPECT_TRUE(stream.next());
  EXPECT_FALSE(stream.next());
  EXPECT_EQ(stream.state().report, "fails");
  EXPECT_EQ(stream.next()->name, "4");
  EXPECT_EQ(stream.state().opened, 2U);
}

TEST(CameraStream, ARecordingMayRepeatAndEnds) {
  std::deque<int> levels = {5, 5};
  CameraStream stream(streamOf(levels, "folder"));
  EXPECT_EQ(stream.period(), 0.1);
  EXPECT_TRUE(stream.next());
  EXPECT_TRUE(stream.next());
  EXPECT_FALSE(stream.next());
  EXPECT_TRUE(stream.state().ended);
}

TEST(CameraStream, ADeviceThatIsGoneIsTriedAgain) {
  FrameSourceConfig config;
  std::deque<int> levels = {-1};
  int calls = 0;
  CameraStream stream(config, [&]() -> std::unique_ptr<FrameSource> {
    if (++calls > 1) throw ConfigError("gone");
    return std::make_unique<LevelSource>(levels, 0);
  });
  EXPECT_FALSE(stream.next());
  EXPECT_FALSE(stream.next());
  EXPECT_EQ(stream.state().report, "gone");
  EXPECT_FALSE(stream.next());
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace microinjection
