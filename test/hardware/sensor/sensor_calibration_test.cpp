#include "hardware/sensor/sensor_calibration.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

class SensorCalibrationTest : public ::testing::Test {
 protected:
  SensorCalibrationTest() { std::filesystem::create_directories(folder); }
  ~SensorCalibrationTest() override { std::filesystem::remove_all(folder); }

  SensorCalibration read(const std::string& text) const {
    std::ofstream(path) << text;
    return readSensorCalibration(path);
  }
  /// The message of the refusal.
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "sensor_calibration_test";
  const std::string path = folder / "force_sensor.yaml";
  const SensorCalibration calibration{Eigen::Vector2d(3.123456789e-6, -5e-6),
                                      (Eigen::Matrix2d() << 1.1, 0.05, -0.03, 0.8).finished(), 3, 1.5e-9};
};

TEST_F(SensorCalibrationTest, IsReadBackToTheBit) {
  const SensorCalibration same = read(toYaml(calibration));
  EXPECT_EQ(same.tare, calibration.tare);
  EXPECT_EQ(same.gain, calibration.gain);
  EXPECT_EQ(same.points, 3);
  EXPECT_EQ(same.residual, 1.5e-9);
}

TEST_F(SensorCalibrationTest, RefusesWhatIsUnknownMissingOrCut) {
  const std::string text = toYaml(calibration);
  EXPECT_NE(refusal(text + "gian: 1\n").find("gian"), std::string::npos);
  EXPECT_NE(refusal("gain: [1, 0, 0, 1]\n").find("tare"), std::string::npos);
  EXPECT_NE(refusal(text.substr(0, text.find("complete"))).find("complete"), std::string::npos);
}

TEST_F(SensorCalibrationTest, RefusesAGainThatNoSensorHas) {
  EXPECT_EQ(gainRefusal(Eigen::Matrix2d::Identity()), "");
  EXPECT_NE(gainRefusal(Eigen::Vector2d(1, 0.001).asDiagonal().toDenseMatrix()), "");
  EXPECT_NE(gainRefusal(Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN())), "");
  SensorCalibration deaf = calibration;
  deaf.gain.row(1).setZero();
  EXPECT_NE(refusal(toYaml(deaf)).find("gain"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
