#include "vision/calibration/calibration_data.h"
#include "vision/calibration/least_distances.h"

namespace microinjection {
namespace {

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
