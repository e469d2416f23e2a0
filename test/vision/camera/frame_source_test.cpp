#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "base/errors.h"
#include "vision/camera/device_source.h"
#include "vision/camera/folder_source.h"
#include "vision/camera/frame_source_config.h"
#include "vision/camera/image_file.h"
#include "vision/camera/video_source.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

class FrameSourceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(::testing::TempDir()) / (std::string("frames_") + info->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  void write(const std::string& name, const cv::Mat& image) const { ASSERT_TRUE(cv::imwrite(path(name), image)); }
  /// Writes an image of noise, whose file is long, without its last part.
  void writeTruncated(const std::string& name) const {
    cv::Mat image(64, 64, CV_8U);
    cv::randu(image, 0, 256);
    write(name, image);
    fs::resize_file(path(name), fs::file_size(path(name)) * 2 / 3);
  }
  static cv::Mat grey(int level, int type = CV_8U) { return cv::Mat(8, 12, type, cv::Scalar::all(level)); }

  fs::path folder;
};

std::string namesOf(FrameSource& source, int count = 100) {
  std::string names;
  for (int i = 0; i < count; ++i) {
    const std::optional<Frame> frame = source.next();
    if (!frame) break;
    names += frame->name + " ";
  }
  return names;
}

TEST_F(FrameSourceTest, AFolderIsPlayedInNaturalOrder) {
  for (const char* name : {"stack0.10.png", "stack0.2.png", "stack0.1.png", "stack10.1.png", "stack3.0.png"})
    write(name, grey(7));
  std::ofstream(path("notes.txt")) << "no image";
  fs::create_directory(path("folder.png"));
  FolderSource source(folder.string(), 10, false);
  EXPECT_EQ(source.size(), 5u);
  EXPECT_EQ(namesOf(source), "stack0.1.png stack0.2.png stack0.10.png stack3.0.png stack10.1.png ");
  EXPECT_TRUE(source.takeReports().empty());
  EXPECT_FALSE(source.next());
}

TEST_F(FrameSourceTest, ALoopStartsAgainAndItsStampsKeepRising) {
  write("a.png", grey(1));
  write("b.png", grey(2));
  FolderSource source(folder.string(), 4, true);
  EXPECT_EQ(source.period(), 0.25);
  for (int i = 0; i < 5; ++i) {
    const std::optional<Frame> frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->name, i % 2 ? "b.png" : "a.png");
    EXPECT_DOUBLE_EQ(frame->stamp.value(), 0.25 * i);
  }
}

TEST_F(FrameSourceTest, AnEmptyFolderHasNoFramesAndAReport) {
  FolderSource source(folder.string(), 10, true);
  EXPECT_FALSE(source.next());
  const std::vector<std::string> reports = source.takeReports();
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_NE(reports[0].find("has no images"), std::string::npos);
  EXPECT_TRUE(source.takeReports().empty());
}

TEST_F(FrameSourceTest, AnAbsentFolderIsRefused) { EXPECT_THROW(FolderSource(path("none"), 10, true), ConfigError); }

TEST_F(FrameSourceTest, FilesThatCannotBeReadAreReportedAndSkipped) {
  write("1.png", grey(1));
  writeTruncated("2.jpg");
  writeTruncated("3.png");
  writeTruncated("4.tif");
  std::ofstream(path("5.png")) << "this is text";
  std::ofstream(path("6.bmp"));
  write("7.png", grey(7));
  FolderSource source(folder.string(), 10, false);
  EXPECT_EQ(source.next()->name, "1.png");
  const std::optional<Frame> last = source.next();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->name, "7.png");
  EXPECT_DOUBLE_EQ(last->stamp.value(), 0.6);
  const std::vector<std::string> reports = source.takeReports();
  ASSERT_EQ(reports.size(), 5u);
  EXPECT_NE(reports[0].find("2.jpg: is truncated"), std::string::npos) << reports[0];
  EXPECT_NE(reports[1].find("3.png: is truncated"), std::string::npos) << reports[1];
  EXPECT_NE(reports[4].find("6.bmp: is empty"), std::string::npos) << reports[4];
}

TEST_F(FrameSourceTest, ALoopWithoutAReadableImageEnds) {
  writeTruncated("1.jpg");
  writeTruncated("2.jpg");
  FolderSource source(folder.string(), 10, true);
  EXPECT_FALSE(source.next());
  EXPECT_EQ(source.takeReports().size(), 2u);
}

TEST_F(FrameSourceTest, AJpegIsTruncatedWhereverItEnds) {
  cv::Mat image(64, 64, CV_8UC3);
  cv::randu(image, 0, 256);
  write("whole.jpg", image);
  EXPECT_EQ(loadImage(path("whole.jpg")).refusal, "");
  const auto size = fs::file_size(path("whole.jpg"));
  for (auto length = size - 1; length > 0; length = length * 9 / 10) {
    fs::copy_file(path("whole.jpg"), path("cut.jpg"), fs::copy_options::overwrite_existing);
    fs::resize_file(path("cut.jpg"), length);
    EXPECT_NE(loadImage(path("cut.jpg")).refusal, "") << length << " of " << size << " bytes";
  }
}

TEST_F(FrameSourceTest, FramesKeepTheirDepthAndColour) {
  write("1.png", grey(60000, CV_16U));
  write("2.png", cv::Mat(4, 4, CV_8UC3, cv::Scalar(10, 20, 30)));
  write("3.tif", grey(40000, CV_16U));
  write("4.png", cv::Mat(4, 4, CV_8UC4, cv::Scalar(1, 2, 3, 4)));
  FolderSource source(folder.string(), 10, false);
  const cv::Mat deep = source.next()->image, colour = source.next()->image, tiff = source.next()->image;
  EXPECT_EQ(deep.type(), CV_16U);
  EXPECT_EQ(deep.at<unsigned short>(0, 0), 60000);
  EXPECT_EQ(colour.type(), CV_8UC3);
  EXPECT_EQ(colour.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(tiff.at<unsigned short>(3, 3), 40000);
  EXPECT_EQ(source.next()->image.type(), CV_8UC4);
}

TEST_F(FrameSourceTest, FloatingPointImagesAreRefused) {
  cv::imwrite(path("1.tif"), cv::Mat(4, 4, CV_32F, cv::Scalar(0.5)));
  EXPECT_EQ(loadImage(path("1.tif")).refusal, "has neither 8 nor 16 bit");
}

class VideoSourceTest : public FrameSourceTest {
 protected:
  void SetUp() override {
    FrameSourceTest::SetUp();
    cv::VideoWriter writer(path("video.avi"), cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20,
                           cv::Size(64, 48));
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < 3; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(50 * (i + 1))));
  }
};

TEST_F(VideoSourceTest, PlaysItsFramesAtTheirRate) {
  VideoSource source(path("video.avi"), 0, false);
  EXPECT_NEAR(source.period(), 0.05, 1e-9);
  for (int i = 0; i < 3; ++i) {
    const std::optional<Frame> frame = source.next();
    ASSERT_TRUE(frame) << i;
    EXPECT_NEAR(frame->image.at<cv::Vec3b>(20, 20)[0], 50 * (i + 1), 3);
    EXPECT_NEAR(frame->stamp.value(), 0.05 * i, 1e-9);
  }
  EXPECT_FALSE(source.next());
}

TEST_F(VideoSourceTest, LoopsAtAnotherRate) {
  VideoSource source(path("video.avi"), 5, true);
  for (int i = 0; i < 8; ++i) {
    const std::optional<Frame> frame = source.next();
    ASSERT_TRUE(frame) << i;
    EXPECT_NEAR(frame->image.at<cv::Vec3b>(20, 20)[0], 50 * (i % 3 + 1), 3);
    EXPECT_NEAR(frame->stamp.value(), 0.2 * i, 1e-9);
  }
}

TEST_F(VideoSourceTest, WhatIsNoVideoIsRefused) {
  std::ofstream(path("text.avi")) << "no video";
  EXPECT_THROW(VideoSource(path("text.avi"), 0, false), ConfigError);
  EXPECT_THROW(VideoSource(path("none.avi"), 0, false), ConfigError);
}

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
    const std::optional<Frame> frame = source->next();
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
    if (property == cv::CAP_PROP_GAIN) values[property] = std::min(value, 5.0);
    if (property == cv::CAP_PROP_AUTO_EXPOSURE || property == cv::CAP_PROP_EXPOSURE) values[property] = value;
    return true;  // as drivers do that keep their own value
  }
  double get(int property) const override { return values.count(property) ? values.at(property) : 0; }
  bool read(cv::OutputArray image) override {
    if (frames == 2) return false;
    buffer.setTo(10 * ++frames);
    values[cv::CAP_PROP_POS_MSEC] = 1500 + 40 * frames;
    image.assign(buffer);
    return true;
  }

  cv::Mat buffer = cv::Mat(48, 64, CV_8U);
  int frames = 0;
  std::map<int, double> values = {{cv::CAP_PROP_FRAME_WIDTH, 64},
                                  {cv::CAP_PROP_FRAME_HEIGHT, 48},
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

TEST(DeviceSource, FramesHaveTheDriversStampAndTheirOwnPixels) {
  DeviceSource source({}, std::make_unique<FakeDevice>());
  EXPECT_TRUE(source.takeReports().empty());
  const std::optional<Frame> first = source.next(), second = source.next();
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(first->stamp.value(), 1.54, 1e-12);
  EXPECT_NEAR(second->stamp.value(), 1.58, 1e-12);
  EXPECT_EQ(first->image.at<unsigned char>(3, 3), 10);
  EXPECT_EQ(second->image.at<unsigned char>(3, 3), 20);
  EXPECT_FALSE(source.next());
  EXPECT_EQ(source.takeReports().size(), 1u);
}

std::string configErrorOf(const std::string& yaml) {
  try {
    ConfigReader reader(YAML::Load(yaml), "test");
    FrameSourceConfig::read(reader);
    reader.finish();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FrameSourceConfig, ReadsEachKindOfSource) {
  EXPECT_EQ(configErrorOf("{source: folder, path: a, rate: 5, loop: true}"), "");
  EXPECT_EQ(configErrorOf("{source: video, path: a.avi, rate: 0}"), "");
  EXPECT_EQ(configErrorOf("{source: device, device: {device: /dev/video2, width: 640, height: 480, format: Y16, "
                          "rate: 30, exposure: 100, gain: 0}}"),
            "");
}

TEST(FrameSourceConfig, RefusesBadKeysAndValues) {
  EXPECT_NE(configErrorOf("{source: film}").find("source = film"), std::string::npos);
  EXPECT_NE(configErrorOf("{source: folder}").find("path"), std::string::npos);
  EXPECT_NE(configErrorOf("{source: folder, path: a, rate: 0}").find("rate"), std::string::npos);
  EXPECT_NE(configErrorOf("{source: folder, path: a, speed: 2}").find("speed"), std::string::npos);
  EXPECT_NE(configErrorOf("{source: device, path: a}").find("path"), std::string::npos);
  EXPECT_NE(configErrorOf("{device: {format: MJPEG}}").find("format = MJPEG"), std::string::npos);
  EXPECT_NE(configErrorOf("{device: {width: 640}}").find("together with height"), std::string::npos);
  EXPECT_NE(configErrorOf("{device: {device: a ! appsink, gain: 1}}").find("is a pipeline"), std::string::npos);
  EXPECT_NE(configErrorOf("{device: {exposure: -1}}").find("exposure = -1"), std::string::npos);
}

TEST_F(FrameSourceTest, IsMadeFromItsConfiguration) {
  write("1.png", grey(1));
  FrameSourceConfig config;
  config.source = "folder";
  config.path = folder.string();
  config.rate = 8;
  const auto source = makeFrameSource(config);
  EXPECT_EQ(source->period(), 0.125);
  EXPECT_EQ(namesOf(*source), "1.png ");
  config.rate = 0;
  EXPECT_THROW(makeFrameSource(config), ConfigError);
}

}  // namespace
}  // namespace microinjection
