#include "vision/calibration/calibration_limits.h"

#include <sstream>

#include "base/config_errors.h"

namespace microinjection {
namespace {

void checkIntervals(const CameraCalibration& calibration, const CalibrationLimits& limits, ConfigErrors& errors) {
  const auto check = [&](CalibrationParameter parameter, double largest) {
    const double half = calibration.interval(parameter).half();
    std::ostringstream allowed;
    allowed << "at most " << largest << ' ' << kCalibrationNames[parameter].unit;
    errors.require(half <= largest, std::string("95 % interval of ") + kCalibrationNames[parameter].name + ": +-", half,
                   std::string(" ") + kCalibrationNames[parameter].unit, allowed.str());
  };
  check(kPixelSize, limits.pixel_size_interval * calibration.value[kPixelSize]);
  check(kAngle, limits.angle_interval);
  check(kTipU, limits.tip_interval);
  check(kTipV, limits.tip_interval);
  check(kBacklashX, limits.backlash_interval);
  check(kBacklashZ, limits.backlash_interval);
  if (calibration.hasFocusAxes()) check(kFocusY, limits.focus_interval);
}

}  // namespace

CalibrationLimits CalibrationLimits::read(ConfigReader& reader) {
  CalibrationLimits limits;
  const Range share{0, 1, true, true};
  reader.choice("mirror", limits.mirror, {"any", "yes", "no"});
  reader.integer("least_points", limits.least_points, Range::closed(8, 1e6));
  reader.integer("least_focus_points", limits.least_focus_points, Range::closed(7, 1e6));
  reader.number("largest_backlash", limits.largest_backlash, Range::positive());
  reader.number("least_spread", limits.least_spread, share);
  reader.number("largest_outlier_share", limits.largest_outlier_share, Range{0, 0.4, false, false});
  reader.number("largest_residual", limits.largest_residual, Range::positive());
  Eigen::VectorXd pixel_size = limits.pixel_size, axis_ratio = limits.axis_ratio;
  reader.vector("pixel_size", pixel_size, Range::positive());
  reader.number("largest_skew", limits.largest_skew, Range::positive());
  reader.vector("axis_ratio", axis_ratio, Range::positive());
  reader.number("pixel_size_interval", limits.pixel_size_interval, Range::positive());
  reader.number("angle_interval", limits.angle_interval, Range::positive());
  reader.number("tip_interval", limits.tip_interval, Range::positive());
  reader.number("backlash_interval", limits.backlash_interval, Range::positive());
  reader.number("focus_interval", limits.focus_interval, Range::positive());
  limits.pixel_size = pixel_size;
  limits.axis_ratio = axis_ratio;
  if (pixel_size[0] >= pixel_size[1]) reader.error("pixel_size", "the lowest must be below the highest");
  if (axis_ratio[0] >= axis_ratio[1]) reader.error("axis_ratio", "the lowest must be below the highest");
  return limits;
}

void CalibrationLimits::validate() const {
  ConfigErrors errors("calibration limits");
  errors.requireOneOf({"any", "yes", "no"}, "mirror", mirror);
  errors.require(Range::closed(8, 1e6), "least_points", least_points);
  errors.require(Range::closed(7, 1e6), "least_focus_points", least_focus_points);
  errors.require(Range{0, 1, true, true}, "least_spread", least_spread);
  errors.require(Range{0, 0.4, false, false}, "largest_outlier_share", largest_outlier_share);
  errors.require(pixel_size[0] > 0 && pixel_size[0] < pixel_size[1], "pixel_size/0", pixel_size[0], " m",
                 "positive and below the highest");
  errors.require(axis_ratio[0] > 0 && axis_ratio[0] < axis_ratio[1], "axis_ratio/0", axis_ratio[0], "",
                 "positive and below the highest");
  for (const auto& [key, value] : {std::pair("largest_backlash", largest_backlash),
                                   {"largest_residual", largest_residual},
                                   {"largest_skew", largest_skew},
                                   {"pixel_size_interval", pixel_size_interval},
                                   {"angle_interval", angle_interval},
                                   {"tip_interval", tip_interval},
                                   {"backlash_interval", backlash_interval},
                                   {"focus_interval", focus_interval}}) {
    errors.require(Range::positive(), key, value);
  }
  errors.throwAny();
}

std::vector<std::string> refusalsOf(const CameraCalibration& calibration, const CalibrationLimits& limits) {
  ConfigErrors errors;
  const auto& value = calibration.value;
  errors.require(limits.mirror == "any" || calibration.mirrored == (limits.mirror == "yes"), "mirrored",
                 calibration.mirrored ? "yes" : "no", "", limits.mirror + ", as configured: the image is flipped");
  errors.require(calibration.residual <= limits.largest_residual, "residual", calibration.residual, " px rms",
                 "at most " + std::to_string(limits.largest_residual) + " px");
  errors.require(Range::closed(limits.pixel_size[0], limits.pixel_size[1]), "pixel_size", value[kPixelSize], " m");
  errors.require(Range::closed(-limits.largest_skew, limits.largest_skew), "skew", value[kSkew], " rad");
  errors.require(Range::closed(limits.axis_ratio[0], limits.axis_ratio[1]), "axis_ratio", value[kAxisRatio]);
  for (const int axis : {kBacklashX, kBacklashY, kBacklashZ}) {
    // Noise makes an absent backlash slightly negative, within its interval.
    const Interval interval = calibration.interval(static_cast<CalibrationParameter>(axis));
    errors.require(interval.high >= 0 && value[axis] <= limits.largest_backlash, kCalibrationNames[axis].name,
                   value[axis], " m", "in " + Range::closed(0, limits.largest_backlash).text() + " m");
  }
  checkIntervals(calibration, limits, errors);
  return errors.messages();
}

}  // namespace microinjection
