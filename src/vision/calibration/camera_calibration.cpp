#include "vision/calibration/camera_calibration.h"

#include <ceres/jet.h>

#include <Eigen/LU>
#include <cmath>

namespace microinjection {
namespace {

bool isOfFocus(int parameter) { return parameter >= kFocusX || parameter == kBacklashY; }

std::string refusalOf(const NewTip& tip, const Play& play, const std::string& date, bool needs_y) {
  if (!isDate(date)) return "date = " + date + ": must be YYYY-MM-DDTHH:MM:SSZ";
  if (!tip.pixel.allFinite()) return "the new tip's pixel is not finite";
  if (!isCovariance(tip.covariance)) return "the new tip's covariance is not finite and positive definite";
  if (tip.focus && !(std::isfinite(*tip.focus) && tip.focus_deviation > 0 && std::isfinite(tip.focus_deviation))) {
    return "the new tip's focus or its deviation is not finite and positive";
  }
  if (!play.position().allFinite()) return "the manipulator's position is not finite";
  for (const int axis : {0, 1, 2}) {
    if (play.known(axis) || (axis == 1 && !needs_y)) continue;
    return std::string("axis ") + "xyz"[axis] + ": its play is not known, move it by more than its backlash first";
  }
  return "";
}

}  // namespace

std::string CameraCalibration::refusalOf(const Eigen::Vector2i& size) const {
  if (image_size.isZero() || size.isZero() || size == image_size) return "";
  const auto text = [](const Eigen::Vector2i& s) { return std::to_string(s.x()) + " x " + std::to_string(s.y()); };
  return "the calibration is of images of " + text(image_size) + " px, this one has " + text(size) +
         " px: images that are binned or cropped need a calibration of their own";
}

std::string CameraCalibration::warning() const {
  if (!image_size.isZero()) return "";
  return "the calibration does not say of which size its images were (width, height): calibrate again, or add them";
}

Interval CameraCalibration::interval(CalibrationParameter parameter) const {
  const double deviation = std::sqrt(covariance(parameter, parameter));
  const double half = studentLimit(kIntervalConfidence, isOfFocus(parameter) ? focus_freedom : freedom) * deviation;
  return {value[parameter] - half, value[parameter] + half};
}

Eigen::Vector2d CameraCalibration::pixelOf(const Eigen::Vector3d& place) const {
  return tipPixel<double>(value, mirrored, place - origin);
}

Eigen::Matrix2d CameraCalibration::pixelCovariance(const Eigen::Vector3d& place) const {
  using Jet = ceres::Jet<double, kCalibrationParameters>;
  CalibrationVector<Jet> p;
  for (int i = 0; i < kCalibrationParameters; ++i) p[i] = Jet(value[i], i);
  const Eigen::Matrix<Jet, 3, 1> offset = (place - origin).cast<Jet>();
  const Eigen::Matrix<Jet, 2, 1> pixel = tipPixel(p, mirrored, offset);
  Eigen::Matrix<double, 2, kCalibrationParameters> derivative;
  for (int i = 0; i < 2; ++i) derivative.row(i) = pixel[i].v.transpose();
  return derivative * covariance * derivative.transpose();
}

Eigen::Vector3d CameraCalibration::placeFor(const Eigen::Vector2d& pixel, double y) const {
  const Eigen::Matrix<double, 2, 3> motion = axes();
  Eigen::Matrix2d plane;
  plane << motion.col(0), motion.col(2);
  const double depth = y - origin.y();
  const Eigen::Vector2d xz = plane.inverse() * (pixel - value.segment<2>(kTipU) - motion.col(1) * depth);
  return origin + Eigen::Vector3d(xz.x(), depth, xz.y());
}

std::optional<double> CameraCalibration::focusOf(const Eigen::Vector3d& place) const {
  if (!estimated[kFocusZero]) return std::nullopt;
  return tipFocus<double>(value, place - origin);
}

std::optional<Eigen::Vector3d> CameraCalibration::focusMotion() const {
  if (!hasFocusAxes()) return std::nullopt;
  Eigen::Matrix3d motion;
  // In metres of the image plane, so that the three rows are of one size.
  motion << value[kPixelSize] * axes(), value.segment<3>(kFocusX).transpose();
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(motion);
  if (!lu.isInvertible()) return std::nullopt;
  return lu.solve(Eigen::Vector3d::UnitZ());
}

std::vector<Eigen::Vector3d> CameraCalibration::commandFor(const Eigen::Vector2d& pixel, const Play& play) const {
  return play.commandFor(placeFor(pixel, play.tip().y()));
}

TipRecord CameraCalibration::tipRecord(const std::string& when) const {
  const Eigen::Vector3d place = placeFor(reference_pixel, origin.y());
  return {when, Eigen::Vector2d(place.x(), place.z())};
}

RezeroResult rezero(const CameraCalibration& calibration, const NewTip& tip, const Play& play,
                    const std::string& date) {
  RezeroResult result;
  result.refusal = refusalOf(tip, play, date, tip.focus && calibration.hasFocusAxes());
  if (!result.refusal.empty()) return result;
  CameraCalibration moved = calibration;
  moved.origin = play.tip();
  moved.value.segment<2>(kTipU) = tip.pixel;
  for (const int i : {int{kTipU}, int{kTipV}, int{kFocusZero}}) {
    moved.covariance.row(i).setZero();
    moved.covariance.col(i).setZero();
  }
  moved.covariance.block<2, 2>(kTipU, kTipU) = calibration.variance_factor * tip.covariance;
  moved.estimated[kFocusZero] = calibration.hasFocusAxes() && tip.focus.has_value();
  moved.value[kFocusZero] = moved.estimated[kFocusZero] ? *tip.focus : 0;
  if (moved.estimated[kFocusZero]) {
    moved.covariance(kFocusZero, kFocusZero) = tip.focus_deviation * tip.focus_deviation;
  }
  const TipRecord record = moved.tipRecord(date);
  result.warning = tipWarning(record, calibration.tips);
  moved.tips.push_back(record);
  result.calibration = moved;
  return result;
}

}  // namespace microinjection
