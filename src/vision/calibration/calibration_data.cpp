#include "vision/calibration/calibration_data.h"

#include <Eigen/SVD>
#include <cmath>
#include <sstream>

#include "base/config_errors.h"
#include "vision/calibration/play.h"
#include "vision/calibration/statistics.h"

namespace microinjection {
namespace {

constexpr double kStill = 1e-9;       ///< m, an axis that moves less is at rest
constexpr int kLeastOfDirection = 3;  ///< observations, of each direction of an axis

std::string nameOf(std::size_t index, const char* what) { return "observation " + std::to_string(index) + ": " + what; }

void checkFinite(const std::vector<TipObservation>& waypoints, ConfigErrors& errors) {
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const TipObservation& each = waypoints[i];
    if (!each.position.allFinite()) errors.add(nameOf(i, "position: must be finite"));
    if (each.pixel && !each.pixel->allFinite()) errors.add(nameOf(i, "pixel: must be finite"));
    if (each.pixel && !isCovariance(each.covariance)) {
      errors.add(nameOf(i, "covariance: must be finite, symmetric and positive definite"));
    }
    if (each.focus && !std::isfinite(*each.focus)) errors.add(nameOf(i, "focus: must be finite"));
    if (each.focus) errors.require(Range::positive(), nameOf(i, "focus_deviation"), each.focus_deviation, " m");
  }
}

/// Fills moved, sides, pixels and focus.
void select(CalibrationData& data, double largest_backlash) {
  const auto& waypoints = data.waypoints;
  for (const TipObservation& each : waypoints) {
    for (int i = 0; i < 3; ++i) {
      data.moved[i] = data.moved[i] || std::abs(each.position[i] - waypoints.front().position[i]) > kStill;
    }
  }
  Play play(Eigen::Vector3d::Constant(largest_backlash), waypoints.front().position);
  Eigen::Vector3i side = Eigen::Vector3i::Zero();
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const Eigen::Vector3d way = waypoints[k].position - play.position();
    play.moveTo(waypoints[k].position);
    bool known = true;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(way[i]) > kStill) side[i] = way[i] > 0 ? 1 : -1;
      known = known && (!data.moved[i] || play.known(i));
    }
    data.sides.push_back(side);
    if (known && waypoints[k].pixel) data.pixels.push_back(static_cast<int>(k));
    if (known && waypoints[k].focus) data.focus.push_back(static_cast<int>(k));
  }
  for (const int k : data.pixels) data.origin += waypoints[k].position / static_cast<double>(data.pixels.size());
}

void checkSpread(const CalibrationData& data, double least, ConfigErrors& errors) {
  Eigen::MatrixXd points(data.pixels.size(), 2);
  for (std::size_t k = 0; k < data.pixels.size(); ++k) {
    const Eigen::Vector3d offset = data.waypoints[data.pixels[k]].position - data.origin;
    points.row(static_cast<Eigen::Index>(k)) << offset.x(), offset.z();
  }
  const Eigen::VectorXd spread = Eigen::JacobiSVD<Eigen::MatrixXd>(points).singularValues();
  const double share = spread[0] > 0 ? spread[1] / spread[0] : 0;
  errors.require(share >= least, "spread of the points across a line", share, "",
                 "at least " + std::to_string(least) + " of the spread along it: they lie on one line");
}

void checkDirections(const CalibrationData& data, ConfigErrors& errors) {
  for (const int axis : {0, 2}) {
    int up = 0, down = 0;
    for (const int k : data.pixels) (data.sides[k][axis] > 0 ? up : down) += 1;
    std::ostringstream name;
    name << "axis "
         << "xyz"[axis] << ": points approached upwards / downwards";
    errors.require(std::min(up, down) >= kLeastOfDirection, name.str(), std::min(up, down), "",
                   "at least " + std::to_string(kLeastOfDirection) + " of each: backlash and place are not separated");
  }
}

void chooseParameters(CalibrationData& data, const CalibrationLimits& limits) {
  const bool focus = static_cast<int>(data.focus.size()) >= limits.least_focus_points;
  if (!focus) data.focus.clear();
  for (const int i : {kPixelSize, kAngle, kSkew, kAxisRatio, kBacklashX, kBacklashZ, kTipU, kTipV}) {
    data.estimated[i] = true;
  }
  data.estimated[kDepthDriftX] = data.estimated[kDepthDriftZ] = data.moved[1];
  data.estimated[kFocusX] = data.estimated[kFocusZ] = data.estimated[kFocusZero] = focus;
  data.estimated[kFocusY] = data.estimated[kBacklashY] = focus && data.moved[1];
}

constexpr int kIterations = 40;
constexpr double kLeastMotion = 1e-3;  ///< px/um, below which the pixel does not follow the needle

/// Columns: 1, then position (um) and side of each used axis.
Eigen::MatrixXd regressorsOf(const CalibrationData& data, const std::vector<int>& indices, const std::vector<int>& axes,
                             const std::vector<int>& sided) {
  Eigen::MatrixXd rows(indices.size(), 1 + axes.size() + sided.size());
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    Eigen::Index column = 0;
    rows(row, column++) = 1;
    for (const int axis : axes) {
      rows(row, column++) = 1e6 * (data.waypoints[indices[k]].position[axis] - data.origin[axis]);
    }
    for (const int axis : sided) rows(row, column++) = data.sides[indices[k]][axis];
  }
  return rows;
}

void startFocus(const CalibrationData& data, CalibrationVector<double>& value) {
  Eigen::MatrixXd observed(data.focus.size(), 1);
  for (std::size_t k = 0; k < data.focus.size(); ++k) {
    observed(static_cast<Eigen::Index>(k), 0) = 1e6 * *data.waypoints[data.focus[k]].focus;
  }
  // With few readings the sides of x and z, whose focus they hardly move, are left to the fit.
  std::vector<int> axes = {0, 2}, sided;
  if (data.moved[1]) axes.push_back(1), sided.push_back(1);
  const Eigen::MatrixXd solution = leastDistances(regressorsOf(data, data.focus, axes, sided), observed, kIterations);
  if (solution.size() == 0) return;
  value[kFocusZero] = 1e-6 * solution(0, 0);
  value[kFocusX] = solution(1, 0);
  value[kFocusZ] = solution(2, 0);
  if (!data.moved[1]) return;
  value[kFocusY] = solution(3, 0);
  if (solution(3, 0) != 0) value[kBacklashY] = -2e-6 * solution(4, 0) / solution(3, 0);
}

}  // namespace

CalibrationData prepareData(const std::vector<TipObservation>& waypoints, const CalibrationLimits& limits,
                            std::vector<std::string>& refusals) {
  ConfigErrors errors;
  CalibrationData data;
  data.waypoints = waypoints;
  checkFinite(waypoints, errors);
  if (errors.good() && !waypoints.empty()) select(data, limits.largest_backlash);
  if (errors.good()) {
    errors.require(static_cast<int>(data.pixels.size()) >= limits.least_points, "points", data.pixels.size(), "",
                   "at least " + std::to_string(limits.least_points) + ", seen after each axis took up its play");
  }
  if (errors.good()) checkSpread(data, limits.least_spread, errors);
  if (errors.good()) checkDirections(data, errors);
  if (errors.good()) chooseParameters(data, limits);
  refusals.insert(refusals.end(), errors.messages().begin(), errors.messages().end());
  return data;
}

std::optional<CalibrationStart> linearStart(const CalibrationData& data) {
  std::vector<int> axes = {0, 2};
  if (data.moved[1]) axes.push_back(1);
  Eigen::MatrixXd observed(data.pixels.size(), 2);
  for (std::size_t k = 0; k < data.pixels.size(); ++k) {
    observed.row(static_cast<Eigen::Index>(k)) = data.waypoints[data.pixels[k]].pixel->transpose();
  }
  const Eigen::MatrixXd solution = leastDistances(regressorsOf(data, data.pixels, axes, {0, 2}), observed, kIterations);
  if (solution.size() == 0) return std::nullopt;
  const auto row = [&](Eigen::Index i) -> Eigen::Vector2d { return solution.row(i).transpose(); };
  const Eigen::Vector2d x = row(1), z = row(2);
  if (!(x.norm() > kLeastMotion && z.norm() > kLeastMotion)) return std::nullopt;
  CalibrationStart start;
  start.mirrored = setImageAxes(start.value, 1e6 * x, 1e6 * z);
  start.value.segment<2>(kTipU) = row(0);
  const auto side = static_cast<Eigen::Index>(1 + axes.size());
  start.value[kBacklashX] = -2e-6 * x.dot(row(side)) / x.squaredNorm();
  start.value[kBacklashZ] = -2e-6 * z.dot(row(side + 1)) / z.squaredNorm();
  if (!data.focus.empty()) startFocus(data, start.value);
  return start;
}

}  // namespace microinjection
