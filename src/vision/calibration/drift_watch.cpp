#include "vision/calibration/drift_watch.h"

#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kMedianVariance = 1.5707963267948966;  ///< pi / 2, of the median over the mean of normal values

std::string sentence(const DriftReport& report, double threshold) {
  std::ostringstream text;
  text.precision(3);
  text << "the tip is seen " << 1e6 * report.distance << " +- " << 1e6 * report.half_width
       << " um from where it is expected; ";
  if (report.verdict == DriftVerdict::kDrifted) {
    text << "it drifted: allowed up to " << 1e6 * threshold << " um";
  } else if (report.verdict == DriftVerdict::kWithin) {
    text << "that is within " << 1e6 * threshold << " um";
  } else {
    text << "noise does not decide whether that is within " << 1e6 * threshold << " um";
  }
  return text.str();
}

}  // namespace

DriftWatchConfig DriftWatchConfig::read(ConfigReader& reader) {
  DriftWatchConfig config;
  reader.number("threshold", config.threshold, Range::positive());
  reader.integer("window", config.window, Range::closed(5, 10000));
  reader.number("confidence", config.confidence, Range{0.5, 1, false, true});
  return config;
}

Eigen::Vector2d DriftWatch::medianOfWindow() const {
  Eigen::Vector2d median;
  for (int i = 0; i < 2; ++i) {
    std::vector<double> values;
    for (const Difference& each : window_) values.push_back(each.pixel[i]);
    median[i] = medianOf(values);
  }
  return median;
}

Eigen::Matrix2d DriftWatch::varianceOf(const Eigen::Matrix2d& expected) const {
  const auto n = static_cast<double>(window_.size());
  Eigen::Matrix2d stated = Eigen::Matrix2d::Zero();
  for (const Difference& each : window_) stated += each.covariance / n;
  for (int i = 0; i < 2; ++i) {
    std::vector<double> values;
    for (const Difference& each : window_) values.push_back(each.pixel[i]);
    stated(i, i) = std::max(stated(i, i), std::pow(robustDeviation(values), 2));
  }
  return kMedianVariance * stated / n + expected;
}

DriftReport DriftWatch::add(const CameraCalibration& calibration, const Eigen::Vector3d& place,
                            const Eigen::Vector2d& seen, const Eigen::Matrix2d& covariance) {
  DriftReport report;
  if (!place.allFinite() || !seen.allFinite() || !isCovariance(covariance)) {
    report.text = "the observation is not finite and was ignored";
    return report;
  }
  window_.push_back({seen - calibration.pixelOf(place), covariance});
  if (window_.size() > static_cast<std::size_t>(config_.window)) window_.pop_front();
  if (window_.size() < static_cast<std::size_t>(config_.window)) {
    report.text = std::to_string(window_.size()) + " of " + std::to_string(config_.window) + " observations";
    return report;
  }
  report.drift = medianOfWindow();
  const double pixel_size = calibration.value[kPixelSize], length = report.drift.norm();
  const Eigen::Matrix2d variance = varianceOf(calibration.pixelCovariance(place));
  const Eigen::Vector2d along = length > 0 ? Eigen::Vector2d(report.drift / length) : Eigen::Vector2d::UnitX();
  const double limit = studentLimit(config_.confidence, config_.window - 1);
  report.distance = pixel_size * length;
  report.half_width = pixel_size * limit * std::sqrt(along.dot(variance * along));
  if (report.distance - report.half_width > config_.threshold) {
    report.verdict = DriftVerdict::kDrifted;
  } else {
    const bool within = report.distance + report.half_width < config_.threshold;
    report.verdict = within ? DriftVerdict::kWithin : DriftVerdict::kUnsure;
  }
  report.text = sentence(report, config_.threshold);
  return report;
}

}  // namespace microinjection
