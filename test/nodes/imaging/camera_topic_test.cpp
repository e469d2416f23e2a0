#include <gtest/gtest.h>

#include <utility>

#include "cell_microinjection/MeasureCell.h"
#include "nodes/imaging/image_input.h"
#include "placed_specimen.h"

namespace microinjection {
namespace {

/// camera.source: topic. The test is another camera's driver, which has the pictures of the virtual microscope.
class CameraTopicTest : public testing::Test {
 protected:
  static constexpr double kRadius = 30e-6;
  static constexpr char kDriver[] = "/driver/image";

  CameraTopicTest() {
    YAML::Node microscope = YAML::LoadFile(MICROINJECTION_SOURCE_DIR "/config/microscope.yaml");
    const YAML::Node camera = YAML::Load(camera_.parameters(5));
    microscope["rate"] = camera["rate"];
    microscope["camera"] = camera["camera"];
    session_.add("microscope", "microscope", microscope, {{"/microscope/image_raw", "/rendered/image_raw"}});
    session_.add("vision", "{pixel_size: 0.25e-6}");
    session_.world().hear<sensor_msgs::Image>("/rendered/image_raw");
    session_.world().publisher<sensor_msgs::Image>(kDriver);
    states();
    session_.run(0.1);
  }

  Probe<cell_microinjection::VisionState>& states() {
    return session_.world().hear<cell_microinjection::VisionState>("/vision/state");
  }
  /// A new image of the microscope.
  sensor_msgs::Image rendered() {
    const auto& images = session_.world().hear<sensor_msgs::Image>("/rendered/image_raw");
    const std::size_t before = images.count();
    EXPECT_TRUE(session_.until([&] { return images.count() > before; }, 1));
    return *images.newest();
  }
  void send(const sensor_msgs::Image& image) {
    session_.world().say(kDriver, image);
    session_.run(0.01);
  }
  /// In another format. A grey scene has the same mosaic as a grey image.
  static sensor_msgs::Image converted(const sensor_msgs::Image& grey, const std::string& encoding, int bytes,
                                      bool deep = false) {
    sensor_msgs::Image image = grey;
    image.encoding = encoding;
    image.step = grey.width * static_cast<unsigned>(bytes);
    image.data.clear();
    for (const std::uint8_t level : grey.data) {
      if (deep) image.data.push_back(0);  // little-endian: 256 times the level
      image.data.insert(image.data.end(), static_cast<std::size_t>(deep ? 1 : bytes), level);
    }
    return image;
  }
  void expectTheCellIsSeen(const sensor_msgs::Image& image) {
    send(image);
    const auto* state = states().newest();
    ASSERT_TRUE(state) << image.encoding;
    EXPECT_EQ(state->header.stamp, image.header.stamp) << image.encoding;
    EXPECT_TRUE(cellIsFound(state)) << image.encoding << ": " << state->cell.reason;
    EXPECT_NEAR(camera_.pixel * state->cell.diameter, 2 * kRadius, 1e-6) << image.encoding;
  }

  SmallCamera camera_;
  VirtualSession session_{{"camera.source:=topic", std::string("camera.topic:=") + kDriver, "hand.device:=none"}};
  PlacedSpecimen specimen_{session_, kRadius};
};

TEST_F(CameraTopicTest, TheCellIsSeenInTheFormatsOfDrivers) {
  expectTheCellIsSeen(converted(rendered(), "mono8", 1));
  expectTheCellIsSeen(converted(rendered(), "rgb8", 3));
  expectTheCellIsSeen(converted(rendered(), "bayer_rggb8", 1));
  expectTheCellIsSeen(converted(rendered(), "bgra8", 4));
  expectTheCellIsSeen(converted(rendered(), "mono16", 2, true));
}

TEST_F(CameraTopicTest, TheBytesOfABigEndianImageAreTurned) {
  sensor_msgs::Image image = converted(rendered(), "mono16", 2, true);
  for (std::size_t i = 0; i < image.data.size(); i += 2) std::swap(image.data[i], image.data[i + 1]);
  image.is_bigendian = 1;
  expectTheCellIsSeen(image);
}

TEST_F(CameraTopicTest, DiagnosticsSayWhyNoImageIsTaken) {
  const auto said = [&](const std::string& reason) {
    const diagnostic_msgs::DiagnosticStatus* status = session_.diagnostics().of("vision: images");
    return status && status->level == diagnostic_msgs::DiagnosticStatus::ERROR &&
           status->message.find(reason) != std::string::npos;
  };
  sensor_msgs::Image image = rendered();
  image.header.stamp = ros::Time();
  send(image);
  EXPECT_TRUE(session_.until([&] { return said("it has no stamp"); }, 2));
  EXPECT_EQ(states().count(), 0u);
  image = rendered();
  const ros::Time stamp = image.header.stamp;
  send(image);
  EXPECT_EQ(states().count(), 1u);
  for (int i = 0; i < 8; ++i) {
    image = rendered();
    image.header.stamp = stamp;
    send(image);
  }
  EXPECT_EQ(states().count(), 1u);
  EXPECT_TRUE(session_.until([&] { return said("its stamp is that of the last one"); }, 2));
  image = rendered();
  image.encoding = "unheard_of";
  send(image);
  EXPECT_TRUE(session_.until([&] { return said("its format or length is wrong"); }, 2));
}

TEST(ImageTopic, OfATransportIsRefusedWithTheWayToUnpackIt) {
  EXPECT_EQ(topicDefect("/camera/image_raw"), "");
  EXPECT_EQ(topicDefect("/compressed"), "");
  const std::string defect = topicDefect("/camera/image/compressed");
  EXPECT_NE(defect.find("republish compressed in:=/camera/image raw"), std::string::npos) << defect;
}

TEST_F(CameraTopicTest, AShortImageIsNotRead) {
  send(rendered());
  ASSERT_EQ(states().count(), 1u);
  for (int i = 0; i < 8; ++i) {
    sensor_msgs::Image image = rendered();
    image.data.pop_back();
    send(image);
  }
  EXPECT_EQ(states().count(), 1u);
  const sensor_msgs::Image whole = rendered();
  send(whole);
  ASSERT_EQ(states().count(), 2u);
  EXPECT_EQ(states().newest()->header.stamp, whole.header.stamp);
}

TEST_F(CameraTopicTest, AnOldImageIsNotRead) {
  constexpr double kTimeout = 0.5;  // s, as shipped
  send(rendered());
  ASSERT_EQ(states().count(), 1u);
  const sensor_msgs::Image kept = rendered();
  session_.run(1.2 * kTimeout);
  send(kept);
  EXPECT_EQ(states().count(), 1u);
  send(rendered());
  EXPECT_EQ(states().count(), 2u);
}

/// As a driver does whose camera has stopped.
TEST_F(CameraTopicTest, AnImageThatComesAgainWithANewStampIsNotRead) {
  sensor_msgs::Image image = rendered();
  send(image);
  ASSERT_EQ(states().count(), 1u);
  image.header.stamp = session_.now();
  send(image);
  EXPECT_EQ(states().count(), 1u);
}

TEST_F(CameraTopicTest, WithoutNewImagesNothingIsMeasured) {
  for (int i = 0; i < 12; ++i) send(rendered());
  const auto measured = session_.call<cell_microinjection::MeasureCell>("vision/measure_cell");
  EXPECT_TRUE(measured.success) << measured.message;
  session_.run(0.6);
  const auto answer = session_.call<cell_microinjection::MeasureCell>("vision/measure_cell");
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("there is no new image"), std::string::npos) << answer.message;
}

}  // namespace
}  // namespace microinjection
