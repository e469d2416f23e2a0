#include "vision/calibration/play.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kPoint = 1e-12;      ///< m, an interval below it is a point
constexpr double kTakeUp = 1.5;       ///< backlashes, of a move that surely crosses the play
constexpr double kTakeUpMore = 1e-6;  ///< m, added to it, because the backlash itself was measured

}  // namespace

void PlayAxis::move(double from, double to, double half) {
  const double now = tip(half);
  if (to > from && to - half >= now) {
    anchor = to;
    side = 1;
  } else if (to < from && to + half <= now) {
    anchor = to;
    side = -1;
  }
}

Play::Play(const Eigen::Vector3d& backlash, const Eigen::Vector3d& position)
    : backlash_(backlash.cwiseMax(0)), position_(position) {
  low_ = position - 0.5 * backlash_;
  high_ = position + 0.5 * backlash_;
}

void Play::moveTo(const Eigen::Vector3d& position) {
  for (int i = 0; i < 3; ++i) {
    const double half = 0.5 * backlash_[i];
    low_[i] = std::clamp(low_[i], position[i] - half, position[i] + half);
    high_[i] = std::clamp(high_[i], position[i] - half, position[i] + half);
  }
  position_ = position;
}

bool Play::known(int axis) const { return high_[axis] - low_[axis] < kPoint; }

std::vector<Eigen::Vector3d> Play::commandFor(const Eigen::Vector3d& tip) const {
  Eigen::Vector3d last = position_, first = position_;
  bool two_moves = false;
  for (int i = 0; i < 3; ++i) {
    const double half = 0.5 * backlash_[i], way = tip[i] - this->tip()[i];
    if (std::abs(way) < kPoint) continue;
    if (known(i)) {
      last[i] = tip[i] + (way > 0 ? half : -half);
      first[i] = last[i];
    } else {
      last[i] = tip[i] + half;
      first[i] = last[i] - kTakeUp * backlash_[i] - kTakeUpMore;
      two_moves = true;
    }
  }
  return two_moves ? std::vector<Eigen::Vector3d>{first, last} : std::vector<Eigen::Vector3d>{last};
}

}  // namespace microinjection
