#include "vision/microscope/camera_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace microinjection {
namespace {

MicroscopeConfig evenLight(double level) {
  MicroscopeConfig config;
  config.camera.width = 400;
  config.camera.height = 300;
  config.illumination = {level, {0, 0}, 0, 0, 0};
  config.sensor.read_noise = 0;
  return config;
}

cv::Mat whole(const MicroscopeConfig& config) {
  return cv::Mat(config.camera.height, config.camera.width, CV_32F, cv::Scalar(1));
}

double varianceOf(const cv::Mat& picture, double* mean) {
  cv::Scalar average, deviation;
  cv::meanStdDev(picture, average, deviation);
  *mean = average[0];
  return deviation[0] * deviation[0];
}

/// 120000 pixels: the variance of their variance is 0.4 % of it.
TEST(CameraSensor, ShotNoiseHasTheVarianceOfTheMeanOverTheGain) {
  for (const double gain : {5.0, 20.0}) {
    for (const double level : {0.15, 0.6}) {
      MicroscopeConfig config = evenLight(level);
      config.sensor.gain = gain;
      const CameraSensor sensor(config);
      double mean = 0;
      const double variance = varianceOf(sensor.expose(whole(config), 1), &mean);
      EXPECT_NEAR(mean, 255 * level, 0.1);
      EXPECT_NEAR(variance - 1.0 / 12, mean / gain, 0.015 * mean / gain) << gain << " " << level;
    }
  }
}

TEST(CameraSensor, ReadNoiseAddsItsVariance) {
  MicroscopeConfig config = evenLight(0.5);
  config.sensor.gain = 10;
  config.sensor.read_noise = 60;
  double mean = 0;
  const double variance = varianceOf(CameraSensor(config).expose(whole(config), 1), &mean);
  EXPECT_NEAR(variance, mean / 10 + 36, 0.015 * (mean / 10 + 36));
}

TEST(CameraSensor, NoiseIsNewInEachPictureAndPixel) {
  MicroscopeConfig config = evenLight(0.5);
  config.sensor.bits = 16;
  const CameraSensor sensor(config);
  cv::Mat a, b;
  sensor.expose(whole(config), 1).convertTo(a, CV_64F);
  sensor.expose(whole(config), 2).convertTo(b, CV_64F);
  a -= cv::mean(a)[0];
  b -= cv::mean(b)[0];
  const double variance = a.dot(a);
  EXPECT_LT(std::abs(a.dot(b)) / variance, 0.012);
  const cv::Mat left = a.colRange(0, 399), right = a.colRange(1, 400), up = a.rowRange(0, 299),
                down = a.rowRange(1, 300);
  EXPECT_LT(std::abs(left.dot(right)) / variance, 0.012);
  EXPECT_LT(std::abs(up.dot(down)) / variance, 0.012);
}

TEST(CameraSensor, TheLightFallsOffAsConfigured) {
  MicroscopeConfig config = evenLight(0.5);
  config.illumination.gradient = {0.2, -0.1};
  const cv::Mat sloped = CameraSensor(config).illumination();
  EXPECT_NEAR(sloped.at<float>(150, 399) - sloped.at<float>(150, 0), 0.2 * 127.5, 0.2);
  EXPECT_NEAR(sloped.at<float>(299, 200) - sloped.at<float>(0, 200), -0.1 * 127.5, 0.2);
  config.illumination = {0.5, {0, 0}, 0.3, 0, 0};
  const cv::Mat vignetted = CameraSensor(config).illumination();
  EXPECT_NEAR(vignetted.at<float>(150, 200), 127.5, 0.1);
  EXPECT_NEAR(vignetted.at<float>(0, 0), 0.7 * 127.5, 0.5);
  config.illumination = {0.5, {0, 0}, 0, 0.6, 0};
  const cv::Mat stopped = CameraSensor(config).illumination();
  EXPECT_NEAR(stopped.at<float>(150, 200), 127.5, 0.1);
  EXPECT_LT(stopped.at<float>(0, 0), 0.1);
}

TEST(CameraSensor, SixteenBitsAndOverExposure) {
  MicroscopeConfig config = evenLight(0.5);
  config.sensor.bits = 16;
  const cv::Mat deep = CameraSensor(config).expose(whole(config), 1);
  EXPECT_EQ(deep.type(), CV_16U);
  EXPECT_NEAR(cv::mean(deep)[0], 32767.5, 2);
  config = evenLight(1.5);
  EXPECT_EQ(
      cv::norm(CameraSensor(config).expose(whole(config), 1), cv::Mat(300, 400, CV_8U, cv::Scalar(255)), cv::NORM_INF),
      0);
}

TEST(CameraSensor, CompressionLosesMoreAtALowerQuality) {
  MicroscopeConfig config = evenLight(0.5);
  const cv::Mat plain = CameraSensor(config).expose(whole(config), 1);
  double before = 0;
  for (const int quality : {98, 90, 70}) {
    config.sensor.jpeg_quality = quality;
    const cv::Mat picture = CameraSensor(config).expose(whole(config), 1);
    ASSERT_EQ(picture.type(), CV_8U);
    const double loss = cv::norm(picture, plain, cv::NORM_L2);
    EXPECT_GT(loss, before) << quality;
    before = loss;
  }
}

}  // namespace
}  // namespace microinjection
