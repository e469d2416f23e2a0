#include "vision/calibration/setpoint_stream.h"

namespace microinjection {
namespace {

constexpr double kHeld = 0.5;             // s behind a resting set-point, from which a needle is not on its way
constexpr double kLargestOffset = 50e-6;  // m: a needle that cannot move is not asked for more and more

}  // namespace

SetpointStream::SetpointStream(const Eigen::Vector3d& position, double arrived, double now)
    : arrived_(arrived), setpoint_(position), goal_(position), since_(now) {}

Eigen::Vector3d SetpointStream::advance(const Eigen::Vector3d& goal, double reach) {
  goal_ = goal;
  const Eigen::Vector3d target = goal_ + offset_, way = target - setpoint_;
  setpoint_ = way.norm() <= reach ? target : Eigen::Vector3d(setpoint_ + reach * way.normalized());
  return setpoint_;
}

bool SetpointStream::arrived(const Eigen::Vector3d& position, double now) {
  const bool rests = setpoint_ == goal_ + offset_;
  const Eigen::Vector3d behind = goal_ - position;
  const bool there = behind.norm() <= arrived_;
  waits_ = rests && !there;
  if (!waits_) since_ = now;
  if (now - since_ >= kHeld) {
    since_ = now;
    if ((offset_ + behind).norm() <= kLargestOffset) offset_ += behind;
  }
  return rests && there;
}

}  // namespace microinjection
