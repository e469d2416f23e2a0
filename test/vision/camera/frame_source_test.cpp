#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "vision/camera/folder_source.h"
#include "vision/camera/frame_source_config.h"
#include "vision/camera/grey_image.h"
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
    const std::optional<CameraFrame> frame = source.next();
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
    const std::optional<CameraFrame> frame = source.next();
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
  const std::optional<CameraFrame> last = source.next();
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
  EXPECT_EQ(loadImage(path("1.tif")).refusal, "has grey levels of floating point, allowed 8 or 16 bit");
}

/// Files as imwrite() does not write them: with another value of a tag.
class TiffFileTest : public FrameSourceTest {
 protected:
  static constexpr int kPhotometric = 262, kSampleFormat = 339;

  void setTag(const std::string& name, int tag, int value) const {
    std::fstream file(path(name), std::ios::binary | std::ios::in | std::ios::out);
    const auto number = [&](std::size_t place, int bytes) {
      unsigned char raw[4] = {};
      file.seekg(static_cast<std::streamoff>(place));
      file.read(reinterpret_cast<char*>(raw), bytes);
      return static_cast<std::size_t>(raw[0] | raw[1] << 8 | raw[2] << 16 | raw[3] << 24);
    };
    const std::size_t directory = number(4, 4), entries = number(directory, 2);
    for (std::size_t i = 0; i < entries; ++i) {
      if (number(directory + 2 + 12 * i, 2) != static_cast<std::size_t>(tag)) continue;
      file.seekp(static_cast<std::streamoff>(directory + 2 + 12 * i + 8));
      const char raw[2] = {static_cast<char>(value & 0xFF), static_cast<char>(value >> 8)};
      file.write(raw, 2);
      return;
    }
    FAIL() << "tag " << tag << " is not in " << name;
  }
  void writePages(const std::string& name, const std::vector<cv::Mat>& pages) const {
    ASSERT_TRUE(cv::imwritemulti(path(name), pages));
  }
};

TEST_F(TiffFileTest, WhereZeroIsWhiteTheLevelsAreTurned) {
  for (const int type : {CV_8U, CV_16U}) {
    write("white.tif", grey(100, type));
    setTag("white.tif", kPhotometric, 0);
    const LoadedImage loaded = loadImage(path("white.tif"));
    ASSERT_EQ(loaded.refusal, "");
    const int white = type == CV_8U ? 255 : 65535;
    EXPECT_EQ(type == CV_8U ? loaded.image.at<unsigned char>(2, 2) : loaded.image.at<unsigned short>(2, 2),
              white - 100);
  }
}

TEST_F(TiffFileTest, LevelsWithASignAreRefused) {
  write("signed.tif", grey(65000, CV_16U));
  setTag("signed.tif", kSampleFormat, 2);
  EXPECT_EQ(loadImage(path("signed.tif")).refusal, "has grey levels with a sign, allowed 8 or 16 bit without");
}

TEST_F(TiffFileTest, AllPagesOfAStackAreRead) {
  writePages("b.tif", {grey(10), grey(20), grey(30)});
  write("a.png", grey(5));
  const ImageFile file(path("b.tif"));
  ASSERT_EQ(file.pages(), 3u);
  for (int page = 0; page < 3; ++page)
    EXPECT_EQ(file.load(static_cast<std::size_t>(page)).image.at<unsigned char>(1, 1), 10 * (page + 1));
  EXPECT_NE(file.load(3).refusal, "");
  EXPECT_EQ(loadImage(path("b.tif")).refusal, "has 3 pages, allowed 1");
  FolderSource source(folder.string(), 10, true);
  EXPECT_EQ(source.next()->name, "a.png");
  for (int page = 1; page <= 3; ++page) {
    const std::optional<CameraFrame> frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->name, "b.tif, page " + std::to_string(page) + " of 3");
    EXPECT_DOUBLE_EQ(frame->stamp.value(), 0.1 * page);
    EXPECT_EQ(frame->image.at<unsigned char>(1, 1), 10 * page);
  }
  EXPECT_EQ(source.next()->name, "a.png");
}

TEST_F(TiffFileTest, AStackThatIsCutIsRefused) {
  cv::Mat noise(64, 64, CV_8U);
  cv::randu(noise, 0, 256);
  writePages("cut.tif", {noise, noise});
  const auto size = fs::file_size(path("cut.tif"));
  for (const double share : {0.98, 0.8, 0.6, 0.45, 0.2, 0.01}) {
    fs::resize_file(path("cut.tif"), static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const ImageFile file(path("cut.tif"));
    EXPECT_NE(file.load(file.pages() - 1).refusal, "") << share;
  }
}

/// Of a stack of more than 4 GB: one directory, and the other images behind the first.
TEST_F(TiffFileTest, AStackOfImageJThatAReaderDoesNotSeeIsRefused) {
  std::string file("II*\0", 4);
  const auto add = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) file += static_cast<char>(value >> (8 * i));
  };
  const auto tag = [&](std::uint32_t name, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
    add(name, 2), add(type, 2), add(count, 4), add(value, 4);
  };
  const std::string text = "ImageJ=1.53t\nimages=7\nslices=7\n";
  add(8, 4), add(8, 2);
  const std::uint32_t behind = 8 + 2 + 8 * 12 + 4, length = static_cast<std::uint32_t>(text.size()) + 1;
  tag(256, 3, 1, 4), tag(257, 3, 1, 4), tag(258, 3, 1, 8), tag(259, 3, 1, 1), tag(262, 3, 1, 1);
  tag(270, 2, length, behind), tag(273, 4, 1, behind + length), tag(279, 4, 1, 16);
  add(0, 4);
  file += text + '\0' + std::string(16 * 7, 'x');
  std::ofstream(path("big.tif"), std::ios::binary) << file;
  const std::string refusal = loadImage(path("big.tif")).refusal;
  EXPECT_NE(refusal.find("stack of ImageJ of 7 images"), std::string::npos) << refusal;
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
    const std::optional<CameraFrame> frame = source.next();
    ASSERT_TRUE(frame) << i;
    EXPECT_NEAR(frame->image.at<cv::Vec3b>(20, 20)[0], 50 * (i + 1), 3);
    EXPECT_NEAR(frame->stamp.value(), 0.05 * i, 1e-9);
  }
  EXPECT_FALSE(source.next());
}

TEST_F(VideoSourceTest, LoopsAtAnotherRate) {
  VideoSource source(path("video.avi"), 5, true);
  for (int i = 0; i < 8; ++i) {
    const std::optional<CameraFrame> frame = source.next();
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
  EXPECT_EQ(configErrorOf("{source: folder, path: /a, rate: 5, loop: true}"), "");
  EXPECT_EQ(configErrorOf("{source: video, path: /a.avi, rate: 0}"), "");
  EXPECT_NE(configErrorOf("{source: video, path: a.avi, rate: 0}").find("must be an absolute path"), std::string::npos);
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

/// Real recordings, which are no part of the project.
class MicrographsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("MICROINJECTION_MICROGRAPHS");
    if (!folder) GTEST_SKIP() << "MICROINJECTION_MICROGRAPHS names no folder of micrographs";
    micrographs = folder;
  }
  std::string micrographs;
};

TEST_F(MicrographsTest, AFocusStackIsPlayedPlaneByPlane) {
  FolderSource source(micrographs + "/holypipette", 30, false);
  const std::string names = namesOf(source);
  EXPECT_EQ(names.rfind("pipette.jpg stack0.0.jpg stack0.1.jpg stack0.2.jpg ", 0), 0u) << names;
  EXPECT_NE(names.find("stack0.9.jpg stack0.10.jpg"), std::string::npos);
  EXPECT_NE(names.find("stack0.16.jpg stack3.0.jpg"), std::string::npos);
  EXPECT_EQ(source.size(), 52u);
  EXPECT_TRUE(source.takeReports().empty());
}

TEST_F(MicrographsTest, SixteenBitAndColourBecomeGrey) {
  for (const char* folder : {"/vampy", "/autooocyte", "/usama_oocyte"}) {
    FolderSource source(micrographs + folder, 30, false);
    const std::optional<CameraFrame> frame = source.next();
    ASSERT_TRUE(frame) << folder;
    EXPECT_EQ(frame->image.depth() == CV_16U, std::string(folder) == "/vampy");
    EXPECT_EQ(frame->image.channels() > 1, std::string(folder) != "/vampy");
    const cv::Mat grey = toGrey8(frame->image);
    ASSERT_EQ(grey.type(), CV_8U);
    cv::Scalar mean, deviation;
    cv::meanStdDev(grey, mean, deviation);
    EXPECT_GT(deviation[0], 0.05 * 255) << folder;  // dark frames as well fill the range
  }
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
