#include "vision/calibration/calibration_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "base/errors.h"
#include "vision/calibration/calibration_trial.h"

namespace microinjection {
namespace {

CameraCalibration calibrated(bool focus = true) {
  SimulatedNeedle needle = needleOf(drawnNeedle(11));
  return *calibrateNeedle(needle, focus).calibration;
}

std::string errorsOf(const std::string& text) {
  try {
    calibrationFromYaml(text, "file");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(const std::string& pattern, const std::string& by) {
  const std::string text = toYaml(calibrated());
  std::string changed = std::regex_replace(text, std::regex(pattern), by, std::regex_constants::format_first_only);
  EXPECT_NE(text, changed) << pattern;
  return changed;
}

TEST(CalibrationFile, ComesBackBitByBit) {
  for (const bool focus : {false, true}) {
    CameraCalibration calibration = calibrated(focus);
    calibration.tips.push_back({"2025-04-01T00:00:00Z", {1.0 / 3e5, -2e-6}});
    const CameraCalibration read = calibrationFromYaml(toYaml(calibration), "file");
    EXPECT_EQ(toYaml(read), toYaml(calibration));
    EXPECT_EQ(read.value, calibration.value);
    EXPECT_EQ(read.covariance, calibration.covariance);
    EXPECT_EQ(read.estimated, calibration.estimated);
    EXPECT_EQ(read.origin, calibration.origin);
    EXPECT_EQ(read.reference_pixel, calibration.reference_pixel);
    EXPECT_EQ(read.mirrored, calibration.mirrored);
    EXPECT_EQ(read.date, calibration.date);
    EXPECT_EQ(read.points, calibration.points);
    EXPECT_EQ(read.residual, calibration.residual);
    EXPECT_EQ(read.tips.back().place, calibration.tips.back().place);
    EXPECT_EQ(read.tips.size(), 2u);
  }
}

TEST(CalibrationFile, HasTheSizeOfItsImages) {
  CameraCalibration calibration = calibrated();
  const std::string old = toYaml(calibration);
  EXPECT_EQ(old.find("width"), std::string::npos);
  EXPECT_NE(calibrationFromYaml(old, "file").warning(), "");
  EXPECT_EQ(calibrationFromYaml(old, "file").refusalOf({640, 480}), "");
  calibration.image_size = {1392, 1040};
  const CameraCalibration read = calibrationFromYaml(toYaml(calibration), "file");
  EXPECT_EQ(read.image_size, calibration.image_size);
  EXPECT_EQ(read.warning(), "");
  EXPECT_EQ(read.refusalOf({1392, 1040}), "");
  EXPECT_EQ(read.refusalOf({0, 0}), "");  // no image was seen yet
  for (const Eigen::Vector2i& size : {Eigen::Vector2i(696, 520), Eigen::Vector2i(1392, 1000)})
    EXPECT_NE(read.refusalOf(size).find("1392 x 1040 px, this one has " + std::to_string(size.x())), std::string::npos);
  EXPECT_NE(errorsOf(replaced("points:", "width: 1392\npoints:")).find("height"), std::string::npos);
}

TEST(CalibrationFile, IsWrittenAndRead) {
  const std::string path = ::testing::TempDir() + "/calibration_file_test/camera.yaml";
  writeCalibration(path, calibrated());
  EXPECT_EQ(toYaml(readCalibration(path)), toYaml(calibrated()));
  std::filesystem::remove_all(std::filesystem::path(path).parent_path());
  EXPECT_THROW(readCalibration(path), ConfigError);
}

TEST(CalibrationFile, ATornFileIsRefusedWhereverItEnds) {
  const std::string text = toYaml(calibrated());
  // Without the last line break the file is whole.
  for (std::size_t length = 0; length + 1 < text.size(); length += length + 200 < text.size() ? 37 : 1) {
    EXPECT_NE(errorsOf(text.substr(0, length)), "") << length;
  }
  EXPECT_EQ(errorsOf(text), "");
}

TEST(CalibrationFile, AnUnknownKeyIsAnError) {
  EXPECT_NE(errorsOf(replaced("mirrored:", "colour: red\nmirrored:")).find("colour"), std::string::npos);
  EXPECT_NE(errorsOf(replaced("    estimated: true", "    estimatd: true")).find("estimatd"), std::string::npos);
}

TEST(CalibrationFile, AMissingKeyIsAnError) {
  EXPECT_NE(errorsOf(replaced("residual: .*\n", "")).find("residual is missing"), std::string::npos);
}

TEST(CalibrationFile, BadValuesAreErrors) {
  EXPECT_NE(errorsOf(replaced("date: \"2025", "date: \"25")).find("date"), std::string::npos);
  EXPECT_NE(errorsOf(replaced("value: [0-9.e-]+", "value: -1e-7")).find("pixel_size/value"), std::string::npos);
  EXPECT_NE(errorsOf(replaced("value: [0-9.e-]+", "value: .nan")).find("pixel_size/value"), std::string::npos);
  EXPECT_NE(errorsOf(replaced("covariance: \\[", "covariance: [1, ")).find("pixel_size/covariance"), std::string::npos);
}

TEST(CalibrationFile, AnEditedValueIsRefused) {
  EXPECT_NE(errorsOf(replaced("value: [0-9.e-]+", "value: 1.5e-7")).find("the file was edited"), std::string::npos);
}

TEST(CalibrationFile, CovariancesThatAreNoneAreRefused) {
  EXPECT_NE(errorsOf(replaced("covariance: \\[[0-9.e-]+", "covariance: [-1")).find("symmetric and not negative"),
            std::string::npos);
}

}  // namespace
}  // namespace microinjection
