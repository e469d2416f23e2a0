#include "sensor/force_readout.h"

#include <Eigen/QR>
#include <cmath>

namespace microinjection {
namespace {

// Forces along nearly one line say nothing certain across it: the smallest pivot must be this share of the largest.
constexpr double kIndependent = 0.05;

int rankOf(const Eigen::MatrixXd& matrix) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kIndependent);
  return static_cast<int>(qr.compute(matrix).rank());
}

}  // namespace

ForceReadout::ForceReadout(int size, double averaging)
    : duration_(averaging),
      tare_(Eigen::VectorXd::Zero(size)),
      gain_(Eigen::MatrixXd::Identity(size, size)),
      sum_(Eigen::VectorXd::Zero(size)) {}

Eigen::VectorXd ForceReadout::read(const Eigen::VectorXd& raw, double time) {
  if (averaging()) {
    if (began_ < 0) began_ = time;
    sum_ += raw;
    ++count_;
    if (time - began_ >= duration_) finishAverage();
  }
  return gain_ * (raw - tare_);
}

std::string ForceReadout::begin(Purpose purpose) {
  if (averaging()) return "an average is under way";
  purpose_ = purpose;
  began_ = -1;
  count_ = 0;
  sum_.setZero();
  return "";
}

std::string ForceReadout::beginTare() {
  std::string refusal = begin(Purpose::kTare);
  if (refusal.empty()) outcome_ = "taring";
  return refusal;
}

std::string ForceReadout::beginPoint(const Eigen::VectorXd& force) {
  if (force.size() != tare_.size() || !force.allFinite()) return "the known force is not finite";
  if (force.isZero(0)) return "the known force is zero: that is what tare is for";
  std::string refusal = begin(Purpose::kPoint);
  if (!refusal.empty()) return refusal;
  known_ = force;
  outcome_ = "averaging under the known force";
  return "";
}

void ForceReadout::interrupt() {
  if (!averaging()) return;
  outcome_ = "the average was given up: no trusted reading all the time";
  purpose_ = Purpose::kNone;
}

void ForceReadout::finishAverage() {
  const Eigen::VectorXd mean = sum_ / count_;
  if (purpose_ == Purpose::kTare) {
    tare_ = mean;
    outcome_ = "tared";
  } else {
    points_.push_back({mean, known_});
    outcome_ = "has " + std::to_string(points()) + " calibration points";
  }
  purpose_ = Purpose::kNone;
}

std::string ForceReadout::solve() {
  if (averaging()) return "an average is under way";
  if (points_.empty()) return "there is no calibration point";
  Eigen::MatrixXd raw(tare_.size(), points()), force(tare_.size(), points());
  for (int i = 0; i < points(); ++i) {
    raw.col(i) = points_[i].raw - tare_;
    force.col(i) = points_[i].force;
  }
  const bool whole = rankOf(force) == tare_.size();
  std::string refusal = whole ? solveMatrix(raw, force) : solveAxes(raw, force);
  if (!refusal.empty()) return refusal;
  residual_ = std::sqrt((gain_ * raw - force).squaredNorm() / static_cast<double>(force.size()));
  outcome_ = whole ? "calibrated: whole matrix" : "calibrated: gain of each axis";
  return "";
}

std::string ForceReadout::solveMatrix(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force) {
  if (rankOf(raw) < tare_.size()) return "the readings do not tell the known forces apart";
  gain_ = raw.transpose().colPivHouseholderQr().solve(force.transpose()).transpose();
  return "";
}

std::string ForceReadout::solveAxes(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force) {
  const Eigen::MatrixXd read = gain_ * raw;
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(tare_.size());
  for (int axis = 0; axis < tare_.size(); ++axis) {
    if (force.row(axis).isZero(0)) continue;
    factor[axis] = force.row(axis).dot(read.row(axis)) / read.row(axis).squaredNorm();
    if (!std::isfinite(factor[axis]) || factor[axis] == 0) return "an axis does not respond to its known force";
  }
  gain_ = factor.asDiagonal() * gain_;
  return "";
}

void ForceReadout::clear() {
  points_.clear();
  gain_.setIdentity();
  residual_ = 0;
  outcome_ = "calibration cleared";
}

}  // namespace microinjection
