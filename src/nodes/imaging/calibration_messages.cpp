#include "nodes/imaging/calibration_messages.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace microinjection {
namespace {

double halfWidth(const CameraCalibration& calibration, CalibrationParameter parameter) {
  const Interval interval = calibration.interval(parameter);
  return (interval.high - interval.low) / 2;
}

}  // namespace

std::string describe(const CameraCalibration& calibration) {
  std::ostringstream text;
  text.precision(5);
  text << "pixel size " << 1e6 * calibration.value[kPixelSize] << " um";
  text << std::fixed << std::setprecision(3) << " +- "
       << 100 * halfWidth(calibration, kPixelSize) / calibration.value[kPixelSize] << " %, angle "
       << 180 / M_PI * calibration.value[kAngle] << " +- " << 180 / M_PI * halfWidth(calibration, kAngle)
       << " degrees, " << (calibration.mirrored ? "mirrored" : "not mirrored") << ", residual " << calibration.residual
       << " px";
  return text.str();
}

cell_microinjection::CalibrateResult toResult(const CameraCalibration& calibration) {
  cell_microinjection::CalibrateResult result;
  result.message = describe(calibration);
  result.pixel_size = calibration.value[kPixelSize];
  result.pixel_size_interval = halfWidth(calibration, kPixelSize);
  result.angle = calibration.value[kAngle];
  result.angle_interval = halfWidth(calibration, kAngle);
  result.mirrored = static_cast<unsigned char>(calibration.mirrored);
  for (int i = 0; i < 3; ++i)
    result.backlash[i] = calibration.estimated[kBacklashX + i] ? calibration.backlash()[i] : 0;
  result.residual = calibration.residual;
  result.points = calibration.points;
  result.outliers = calibration.outliers;
  return result;
}

}  // namespace microinjection
