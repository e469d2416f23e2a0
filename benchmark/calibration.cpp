// Calibration of the camera: errors, landing and coverage of simulated sessions, in three conditions.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/simulated_needle.h"
#include "vision/calibration/calibrate.h"
#include "vision/calibration/calibration_pattern.h"

namespace microinjection {
namespace {

constexpr int kLandings = 20;                    // moves of a trial, to random places of the image
constexpr double kWidth = 1391, kHeight = 1039;  // px
constexpr double kRadians = 3.14159265358979323846 / 180;

struct Condition {
  const char* name;
  double outlier_share, depth;
};
constexpr Condition kConditions[] = {{"plain", 0, 0}, {"outliers", 0.05, 0}, {"focus", 0, 20e-6}};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class Table {
 public:
  explicit Table(int trials) : trials_(trials) {}

  std::string make() {
    emit("condition,trial,duration_s,refused,pixel_size_error,angle_error_deg,landing_error_um,covered,parameters\n");
    for (const Condition& condition : kConditions) {
      sizes_.clear(), angles_.clear(), landings_.clear();
      refused_ = covered_ = parameters_ = 0;
      for (int trial = 1; trial <= trials_; ++trial) add(condition, trial);
      summarize(condition);
    }
    return rows_;
  }

 private:
  void add(const Condition& condition, int trial) {
    SimulatedNeedleConfig truth = drawnNeedle(100000 + static_cast<std::uint64_t>(trial));
    truth.outlier_share = condition.outlier_share;
    CalibrationPatternConfig pattern;
    pattern.depth = condition.depth;
    const Eigen::Vector3d start(3e-6, 0, -2e-6);
    const TravelBox box{Eigen::Vector3d::Constant(-1e-3), Eigen::Vector3d::Constant(1e-3)};
    const CalibrationPlan plan = planCalibration(pattern, Eigen::Vector3d::Zero(), start, box);
    SimulatedNeedle needle(truth, start);
    const CalibrationOutcome outcome = calibrate(needle.observe(plan.waypoints), {}, {"2025-01-01T00:00:00Z", {}, {}});
    if (!outcome.calibration) {
      ++refused_;
      emit(std::string(condition.name) + ',' + std::to_string(trial) + ',' + std::to_string(plan.duration) +
           ",yes,,,,,\n");
      return;
    }
    const CameraCalibration& found = *outcome.calibration;
    const auto [covered, parameters] = coverage(truth, needle, found);
    const double size = found.value[kPixelSize] / truth.value[kPixelSize] - 1;
    const double angle = std::remainder(found.value[kAngle] - truth.value[kAngle], 360 * kRadians) / kRadians;
    const double landing = largestLanding(truth, found, plan, needle);
    sizes_.push_back(std::abs(size));
    angles_.push_back(std::abs(angle));
    covered_ += covered;
    parameters_ += parameters;
    char text[200];
    std::snprintf(text, sizeof text, "%s,%d,%.1f,no,%.3e,%.4f,%.4f,%d,%d\n", condition.name, trial, plan.duration, size,
                  angle, 1e6 * landing, covered, parameters);
    emit(text);
  }

  static std::pair<int, int> coverage(const SimulatedNeedleConfig& truth, const SimulatedNeedle& needle,
                                      const CameraCalibration& found) {
    CalibrationVector<double> value = truth.value;
    Eigen::Vector3d offset = found.origin - truth.origin;
    // The play of an axis y that did not move is a part of the tip's place.
    if (!found.estimated[kDepthDriftX]) offset.y() = needle.place().y() - truth.origin.y();
    value.segment<2>(kTipU) = tipPixel<double>(truth.value, truth.mirrored, offset);
    value[kFocusZero] = tipFocus<double>(truth.value, offset);
    int covered = 0, parameters = 0;
    for (int i = 0; i < kCalibrationParameters; ++i) {
      if (!found.estimated[i]) continue;
      ++parameters;
      covered += found.interval(static_cast<CalibrationParameter>(i)).contains(value[i]) ? 1 : 0;
    }
    return {covered, parameters};
  }

  /// Moves to random pixels of the whole image, one after the other. Returns the largest error (m).
  double largestLanding(const SimulatedNeedleConfig& truth, const CameraCalibration& found, const CalibrationPlan& plan,
                        SimulatedNeedle& needle) {
    Play play(found.backlash(), plan.waypoints.front().position);
    for (const CalibrationWaypoint& each : plan.waypoints) play.moveTo(each.position);
    double largest = 0;
    for (int i = 0; i < kLandings; ++i) {
      const Eigen::Vector2d goal(kWidth * needle.uniform(), kHeight * needle.uniform());
      for (const Eigen::Vector3d& position : found.commandFor(goal, play)) {
        needle.moveTo(position);
        play.moveTo(position);
      }
      landings_.push_back(truth.value[kPixelSize] * (needle.truePixel() - goal).norm());
      largest = std::max(largest, landings_.back());
    }
    return largest;
  }

  void summarize(const Condition& condition) const {
    std::fprintf(
        stderr,
        "%s: %d trials, %d refused; pixel size error 95 %% %.2e, largest %.2e; angle error 95 %% %.4f, largest "
        "%.4f degrees; landing 95 %% %.3f, largest %.3f um; %.2f %% of the 95 %% intervals hold the truth\n",
        condition.name, trials_, refused_, quantile(sizes_, 0.95), quantile(sizes_, 1), quantile(angles_, 0.95),
        quantile(angles_, 1), 1e6 * quantile(landings_, 0.95), 1e6 * quantile(landings_, 1),
        100.0 * covered_ / std::max(1, parameters_));
  }

  void emit(const std::string& text) {
    std::cout << text << std::flush;
    rows_ += text;
  }

  int trials_;
  std::string rows_;
  std::vector<double> sizes_, angles_, landings_;
  int refused_ = 0, covered_ = 0, parameters_ = 0;
};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  int trials = 1000;
  boost::program_options::options_description more;
  more.add_options()("trials", boost::program_options::value(&trials)->default_value(trials), "of each condition");
  return microinjection::benchMain(
      argc, argv, "calibration: errors, landing and coverage of the camera's calibration",
      [&] { return microinjection::Table(trials).make(); }, more);
}
