#include "vision/camera/device_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

TEST(DeviceSource, AnAbsentDeviceIsRefusedByName) {
  DeviceSourceConfig config;
  config.device = "/dev/video_that_is_absent";
  try {
    DeviceSource source(config);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("device = /dev/video_that_is_absent"), std::string::npos) << error.what();
  }
}

TEST(DeviceSource, ReadsAPipelineToItsEnd) {
  DeviceSourceConfig config;
  config.device = "videotestsrc num-buffers=3 ! video/x-raw,format=GRAY8,width=64,height=48,framerate=25/1 ! appsink";
  std::unique_ptr<DeviceSource> source;
  try {
    source = std::make_unique<DeviceSource>(config);
  } catch (const ConfigError& error) {
    GTEST_SKIP() << "this OpenCV has no GStreamer, or GStreamer no test source: " << error.what();
  }
  EXPECT_EQ(source->period(), 0);
  for (int i = 0; i < 3; ++i) {
    const std::optional<CameraFrame> frame = source->next();
    ASSERT_TRUE(frame) << i;
    EXPECT_EQ(frame->image.size(), cv::Size(64, 48));
    EXPECT_EQ(frame->name, std::to_string(i));
  }
  EXPECT_TRUE(source->takeReports().empty());
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->takeReports().size(), 1u);
}

/// A camera that has one size, takes gains up to 5, and delivers two frames from one buffer.
class FakeDevice : public cv::VideoCapture {
 public:
  bool set(int property, double value) override {
    if (property == cv::CAP_PROP_CONVERT_RGB && converts) values[property] = value;
    if (property == cv::CAP_PROP_GAIN) values[property] = std::min(value, 5.0);
    if (property == cv::CAP_PROP_AUTO_EXPOSURE || property == cv::CAP_PROP_EXPOSURE) values[property] = value;
    return true;  // as drivers do that keep their own value
  }
  double get(int property) const override { return values.count(property) ? values.at(property) : 0; }
  bool read(cv::OutputArray image) override {
    // As OpenCV: 16 bit only without conversion.
    buffer.create(48, 64, values[cv::CAP_PROP_CONVERT_RGB] == 0 && is_deep ? CV_16U : CV_8U);
    if (frames == 2) return false;
    buffer.setTo(10 * ++frames);
    values[cv::CAP_PROP_POS_MSEC] = 1500 + 40 * frames;
    image.assign(buffer);
    return true;
  }

  cv::Mat buffer = cv::Mat(48, 64, CV_8U);
  int frames = 0;
  bool is_deep = false, converts = true;
  std::map<int, double> values = {{cv::CAP_PROP_FRAME_WIDTH, 64},
                                  {cv::CAP_PROP_FRAME_HEIGHT, 48},
                                  {cv::CAP_PROP_CONVERT_RGB, 1},
                                  {cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('Y', 'U', 'Y', 'V')}};
};

TEST(DeviceSource, ReportsWhatTheDeviceRefused) {
  DeviceSourceConfig config;
  config.width = 320;
  config.height = 48;
  config.format = "Y16";
  config.exposure = 100;
  config.gain = 20;
  DeviceSource source(config, std::make_unique<FakeDevice>());
  const std::vector<std::string> refused = source.takeReports();
  EXPECT_EQ(refused, (std::vector<std::string>{"format = Y16: the device has YUYV",
                                               "width = 320 px: the device has 64 px", "gain = 20: the device has 5"}));
}

/// A camera that takes all at once and makes of it what it can with its first frame, and whose knob is turned later.
class LateDevice : public FakeDevice {
 public:
  bool set(int property, double value) override {
    values[property] = value;
    return true;
  }
  double get(int property) const override {
    if (property == cv::CAP_PROP_GAIN && frames > 100) return 7;
    if (property == cv::CAP_PROP_EXPOSURE && frames > 0) return 80;
    return FakeDevice::get(property);
  }
  bool read(cv::OutputArray image) override {
    buffer.setTo(++frames % 256);
    image.assign(buffer);
    return true;
  }
};

TEST(DeviceSource, ReadsBackWhatTheDeviceHasMadeOfItsSettings) {
  DeviceSourceConfig config;
  config.width = 640;
  config.height = 480;
  config.exposure = 100;
  config.gain = 3;
  DeviceSource source(config, std::make_unique<LateDevice>());
  EXPECT_TRUE(source.takeReports().empty()) << "it says that it has all";
  ASSERT_TRUE(source.next());
  EXPECT_EQ(source.takeReports(), (std::vector<std::string>{"width, height = 640, 480 px: the frames have 64 x 48 px",
                                                            "exposure = 100: the device has 80"}));
  EXPECT_NE(source.settings().find("64 x 48 px"), std::string::npos) << source.settings();
  EXPECT_NE(source.settings().find("exposure 80, gain 3"), std::string::npos) << source.settings();
  std::vector<std::string> later;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(source.next());
    for (const std::string& report : source.takeReports()) later.push_back(report);
  }
  EXPECT_EQ(later, std::vector<std::string>{"gain = 3: the device has 7"}) << "once";
}

TEST(DeviceSource, SixteenBitStaySixteenOrItIsReported) {
  for (const bool converts : {true, false}) {
    auto device = std::make_unique<FakeDevice>();
    device->values[cv::CAP_PROP_FOURCC] = cv::VideoWriter::fourcc('Y', '1', '6', ' ');
    device->is_deep = true;
    device->converts = converts;
    DeviceSource source({}, std::move(device));
    const std::optional<CameraFrame> first = source.next(), second = source.next();
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->image.depth(), converts ? CV_16U : CV_8U);
    const std::vector<std::string> reports = source.takeReports();
    ASSERT_EQ(reports.size(), converts ? 0U : 1U);
    if (!converts) EXPECT_NE(reports[0].find("16 bit, of which OpenCV leaves 8"), std::string::npos);
  }
}

TEST(DeviceSource, FramesHaveTheDriversStampAndTheirOwnPixels) {
  DeviceSource source({}, std::make_unique<FakeDevice>());
  EXPECT_TRUE(source.takeReports().empty());
  const std::optional<CameraFrame> first = source.next(), second = source.next();
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(first->stamp.value(), 1.54, 1e-12);
  EXPECT_NEAR(second->stamp.value(), 1.58, 1e-12);
  EXPECT_EQ(first->image.at<unsigned char>(3, 3), 10);
  EXPECT_EQ(second->image.at<unsigned char>(3, 3), 20);
  EXPECT_FALSE(source.next());
  EXPECT_EQ(source.takeReports().size(), 1u);
}

}  // namespace
}  // namespace microinjection
