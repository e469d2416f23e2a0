#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "placed_specimen.h"

namespace microinjection {
namespace {

/// The virtual microscope looks at a cell and a needle that the test places.
class MicroscopeTest : public testing::Test {
 protected:
  static constexpr double kRate = 5, kRadius = 40e-6, kStateTimeout = 0.5;

  MicroscopeTest() {
    session_.add("microscope", camera_.parameters(kRate, "needle: measured"));
    session_.world().hear<sensor_msgs::JointState>("/focus/measured_js");
    session_.world().hear<sensor_msgs::Image>("/microscope/image_raw");
    session_.world().hear<sensor_msgs::CameraInfo>("/microscope/camera_info");
  }

  Probe<sensor_msgs::Image>& images() { return session_.world().hear<sensor_msgs::Image>("/microscope/image_raw"); }
  /// Exposed from now on.
  cv::Mat newImage() {
    const std::size_t before = images().count();
    if (!session_.until([&] { return images().count() > before; }, 1)) {
      ADD_FAILURE() << "no image";
      return cv::Mat::zeros(camera_.height, camera_.width, CV_8U);
    }
    return greyLevels(*images().newest());
  }
  /// Grey levels of the row through the cell's centre: the mean of seven rows.
  cv::Mat profile(const cv::Mat& image) const {
    const int row = static_cast<int>(camera_.origin.y());
    cv::Mat mean;
    cv::reduce(image.rowRange(row - 3, row + 4), mean, 0, cv::REDUCE_AVG, CV_64F);
    return mean;
  }
  static double steepest(const cv::Mat& profile) {
    double largest = 0;
    for (int i = 1; i < profile.cols; ++i)
      largest = std::max(largest, std::abs(profile.at<double>(i) - profile.at<double>(i - 1)));
    return largest;
  }
  double focus() { return session_.world().hear<sensor_msgs::JointState>("/focus/measured_js").newest()->position[0]; }
  void moveFocus(const std::vector<double>& position, double ahead = 0) {
    sensor_msgs::JointState message;
    if (ahead > 0) message.header.stamp = session_.now() + ros::Duration(ahead);
    message.name = {"focus"};
    message.position = position;
    session_.world().say("/focus/move_jp", message);
  }
  /// That images end within the time-out of the cell's state, and a period.
  void expectImagesEnd() {
    session_.run(kStateTimeout + 1 / kRate + 0.02);
    images().clear();
    session_.run(1);
    EXPECT_EQ(images().count(), 0u);
  }

  SmallCamera camera_;
  VirtualSession session_{{"camera.source:=sim", "hand.device:=none"}};
  PlacedSpecimen specimen_{session_, kRadius, {20e-6, 0, 60e-6}};
};

TEST_F(MicroscopeTest, NeedleAndCellAreWhereTheyAreSaidToBe) {
  session_.run(0.1);
  const cv::Mat image = newImage();
  EXPECT_EQ(images().newest()->encoding, "mono8");
  EXPECT_EQ(images().newest()->header.frame_id, "microscope_optical_frame");
  const auto* info = session_.world().hear<sensor_msgs::CameraInfo>("/microscope/camera_info").newest();
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, static_cast<unsigned>(camera_.width));
  EXPECT_EQ(info->height, static_cast<unsigned>(camera_.height));
  EXPECT_EQ(image.size(), cv::Size(camera_.width, camera_.height));
  // The needle's walls make contrast above its tip, and none below.
  const Eigen::Vector2d tip = camera_.pixelOf(specimen_.tip.x(), specimen_.tip.z());
  const int column = static_cast<int>(std::lround(tip.x())), row = static_cast<int>(std::lround(tip.y()));
  const auto contrast = [&](int of_row) {
    cv::Scalar mean, deviation;
    cv::meanStdDev(image.row(of_row).colRange(column - 60, column + 60), mean, deviation);
    return deviation[0];
  };
  double least_above = std::numeric_limits<double>::infinity(), most_below = 0;
  for (int i = row - 30; i < row - 10; ++i) least_above = std::min(least_above, contrast(i));
  for (int i = row + 15; i < row + 30; ++i) most_below = std::max(most_below, contrast(i));
  EXPECT_GT(least_above, 3 * most_below);
  // The ooplasm's dark rim reaches outwards from the border, on both sides of the cell.
  const cv::Mat levels = profile(image);
  const int reach = static_cast<int>(kRadius / camera_.pixel);
  for (const int side : {-1, 1}) {
    const int centre = static_cast<int>(std::lround(camera_.origin.x() + side * reach));
    cv::Point darkest;
    cv::minMaxLoc(levels.colRange(centre - 20, centre + 20), nullptr, nullptr, &darkest);
    const double rim = centre - 20 + darkest.x - camera_.origin.x();
    EXPECT_NEAR(std::abs(rim) * camera_.pixel, kRadius, 2e-6);
  }
}

TEST_F(MicroscopeTest, FocusMovesAndBlurs) {
  session_.run(0.1);
  const int right = static_cast<int>(camera_.origin.x()) + 200;  // without the edge of the image
  const double sharp = steepest(profile(newImage()).colRange(0, right));
  moveFocus({20e-6});
  session_.run(0.1);
  EXPECT_LT(focus(), 20e-6 - 1e-9);  // it is a motor
  EXPECT_TRUE(session_.until([&] { return std::abs(focus() - 20e-6) < 1e-12; }, 1));
  EXPECT_LT(steepest(profile(newImage()).colRange(0, right)), sharp);
  for (const std::vector<double>& wrong : {std::vector<double>{1.0}, std::vector<double>{NAN}, std::vector<double>{}}) {
    moveFocus(wrong);
    session_.run(0.7);
    EXPECT_NEAR(focus(), 20e-6, 1e-12);
  }
  moveFocus({0}, 60);  // of a machine whose clock is wrong
  session_.run(0.7);
  EXPECT_NEAR(focus(), 20e-6, 1e-12);
  moveFocus({0});
  EXPECT_TRUE(session_.until([&] { return focus() == 0; }, 1));
}

TEST_F(MicroscopeTest, OfACellThatIsSilentThereIsNoImage) {
  session_.run(0.1);
  newImage();
  specimen_.cell_is_silent = true;
  expectImagesEnd();
  specimen_.cell_is_silent = false;
  session_.run(0.1);
  newImage();
}

TEST_F(MicroscopeTest, OfACellThatIsNotFiniteThereIsNoImage) {
  session_.run(0.1);
  newImage();
  const float height = specimen_.cell.vertices[5].z;
  specimen_.cell.vertices[5].z = std::numeric_limits<float>::quiet_NaN();
  expectImagesEnd();
  specimen_.cell.vertices[5].z = height;
  session_.run(0.1);
  newImage();
}

}  // namespace
}  // namespace microinjection
