#include "rig/sensor/force_readout.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

// Forces along nearly one line do not determine the gain across it. The smallest pivot must be at
// least this share of the largest.
constexpr double kIndependent = 0.05;

// Transformation into the sensor's frame leaves this share of an axial force on the other axes.
constexpr double kRounding = 1e-6;

// A sensor outside this range is not wired or not configured as in the file.
constexpr double kLargestGain = 100;  // of a force's size, and its inverse the smallest
// A usable fit leaves a few percent; a gain of zero leaves 1.
constexpr double kLargestResidual = 0.5;  // of the known forces, rms

double rmsOf(const Eigen::MatrixXd& forces) {
  return std::sqrt(forces.squaredNorm() / static_cast<double>(forces.size()));
}

/// Returns an empty text, or the reason why no sensor has this gain.
std::string gainRefusal(const Eigen::MatrixXd& gain, double residual, double known) {
  if (!gain.allFinite() || !std::isfinite(residual)) return "the gain that fits the points is not finite";
  const Eigen::VectorXd factors = Eigen::JacobiSVD<Eigen::MatrixXd>(gain).singularValues();
  std::ostringstream text;
  if (factors.maxCoeff() > kLargestGain || factors.minCoeff() < 1 / kLargestGain) {
    text << "the gain that fits the points changes forces by factors from " << factors.minCoeff() << " to "
         << factors.maxCoeff() << ", allowed [" << 1 / kLargestGain << ", " << kLargestGain << "]";
  } else if (residual > kLargestResidual * known) {
    text << "the points differ from the fit by " << residual << " N rms, allowed up to " << kLargestResidual * known
         << " N, half of the known forces";
  }
  return text.str();
}

int rankOf(const Eigen::MatrixXd& matrix) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kIndependent);
  return static_cast<int>(qr.compute(matrix).rank());
}

}  // namespace

ForceReadout::ForceReadout(const Eigen::VectorXd& range, double averaging)
    : range_(range),
      duration_(averaging),
      tare_(Eigen::VectorXd::Zero(range.size())),
      gain_(Eigen::MatrixXd::Identity(range.size(), range.size())),
      sum_(Eigen::VectorXd::Zero(range.size())) {}

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
  if (force.isZero(0)) return "the known force is zero: use tare instead";
  for (int axis = 0; axis < force.size(); ++axis) {
    if (std::abs(force[axis]) <= range_[axis]) continue;
    std::ostringstream text;
    text << "the known " << (axis == 0 ? "axial" : "lateral") << " force = " << force[axis] << " N, allowed ["
         << -range_[axis] << ", " << range_[axis] << "] N";
    return text.str();
  }
  std::string refusal = begin(Purpose::kPoint);
  if (!refusal.empty()) return refusal;
  known_force_ = force;
  outcome_ = "averaging under the known force";
  return "";
}

void ForceReadout::interrupt() {
  if (!averaging()) return;
  outcome_ = "the average was aborted: not every reading was valid";
  purpose_ = Purpose::kNone;
}

void ForceReadout::finishAverage() {
  const Eigen::VectorXd mean = sum_ / count_;
  if (!mean.allFinite()) return interrupt();
  if (purpose_ == Purpose::kTare) {
    tare_ = mean;
    outcome_ = "tared";
  } else {
    points_.push_back({mean, known_force_});
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
  Eigen::MatrixXd gain = gain_;
  std::string refusal = whole ? solveMatrix(raw, force, gain) : solveAxes(raw, force, gain);
  const double residual = rmsOf(gain * raw - force);
  if (refusal.empty()) refusal = gainRefusal(gain, residual, rmsOf(force));
  if (!refusal.empty()) return refusal;
  gain_ = gain;
  residual_ = residual;
  outcome_ = whole ? "calibrated: whole matrix" : "calibrated: gain of each axis";
  return "";
}

std::string ForceReadout::solveMatrix(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force,
                                      Eigen::MatrixXd& gain) const {
  if (rankOf(raw) < tare_.size()) return "the readings do not distinguish the known forces";
  gain = raw.transpose().colPivHouseholderQr().solve(force.transpose()).transpose();
  return "";
}

std::string ForceReadout::solveAxes(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& force,
                                    Eigen::MatrixXd& gain) const {
  const Eigen::MatrixXd read = gain * raw;
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(tare_.size());
  for (int axis = 0; axis < tare_.size(); ++axis) {
    if (force.row(axis).norm() <= kRounding * force.norm()) continue;
    factor[axis] = force.row(axis).dot(read.row(axis)) / read.row(axis).squaredNorm();
    if (!std::isfinite(factor[axis]) || factor[axis] == 0) return "an axis does not respond to its known force";
  }
  gain = factor.asDiagonal() * gain;
  return "";
}

void ForceReadout::clear() {
  points_.clear();
  gain_.setIdentity();
  residual_ = 0;
  outcome_ = "calibration cleared";
}

}  // namespace microinjection
