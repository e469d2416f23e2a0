#include "hardware/sensor/force_readout.h"

#include <Eigen/QR>
#include <cmath>
#include <sstream>
#include <utility>

namespace microinjection {
namespace {

// Forces along nearly one line do not determine the gain across it. The smallest pivot must be at
// least this share of the largest.
constexpr double kIndependent = 0.05;

// Transformation into the sensor's frame leaves this share of an axial force on the other axes.
constexpr double kRounding = 1e-6;

// A usable fit leaves a few percent; a gain of zero leaves 1.
constexpr double kLargestResidual = 0.5;  // of the known forces, rms
constexpr std::size_t kMostSteps = 100;   // that can be taken back

double rmsOf(const Eigen::MatrixXd& forces) {
  return std::sqrt(forces.squaredNorm() / static_cast<double>(forces.size()));
}

/// Returns an empty text, or the reason why points with these known forces (N rms) do not give this gain.
std::string fitRefusal(const Eigen::MatrixXd& gain, double residual, double known) {
  const std::string refusal = gainRefusal(gain);
  if (!refusal.empty()) return refusal;
  if (std::isfinite(residual) && residual <= kLargestResidual * known) return "";
  std::ostringstream text;
  text << "the points differ from the fit by " << residual << " N rms, allowed up to " << kLargestResidual * known
       << " N, half of the known forces";
  return text.str();
}

/// For people: "1.23, 0.1 uN", along and across.
std::string axesText(const Eigen::VectorXd& forces) {
  std::ostringstream text;
  text.precision(3);
  for (Eigen::Index axis = 0; axis < forces.size(); ++axis) text << (axis > 0 ? ", " : "") << 1e6 * forces[axis];
  text << " uN";
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
      sum_(Eigen::VectorXd::Zero(range.size())),
      squares_(sum_),
      first_(sum_),
      noise_(sum_) {}

Eigen::VectorXd ForceReadout::read(const Eigen::VectorXd& raw, double time) {
  if (averaging()) {
    if (began_ < 0) {
      began_ = time;
      first_ = raw;
    }
    sum_ += raw;
    squares_ += (raw - first_).cwiseAbs2();
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
  squares_.setZero();
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

void ForceReadout::interrupt(const char* reason) {
  if (!averaging()) return;
  outcome_ = std::string("the average was aborted: ") + reason;
  purpose_ = Purpose::kNone;
}

void ForceReadout::finishAverage() {
  const Eigen::VectorXd mean = sum_ / count_;
  if (!mean.allFinite()) return interrupt("not every reading was finite");
  noise_ = (squares_ / count_ - (mean - first_).cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  remember();
  if (purpose_ == Purpose::kTare) {
    tare_ = mean;
    ++changes_;
  } else {
    points_.push_back({mean, known_force_});
  }
  reportAverage();
  purpose_ = Purpose::kNone;
}

void ForceReadout::reportAverage() {
  const std::string noise = "; noise " + axesText(noise_) + " rms";
  if (purpose_ == Purpose::kTare) {
    outcome_ = "tared" + noise;
  } else {
    outcome_ = "calibration point " + std::to_string(points()) + ": known " + axesText(known_force_) + ", measured " +
               axesText(gain_ * (points_.back().raw - tare_)) + noise;
  }
}

void ForceReadout::remember() {
  if (steps_.size() == kMostSteps) steps_.erase(steps_.begin());
  steps_.push_back({tare_, gain_, points_, residual_, fitted_});
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
  if (refusal.empty()) refusal = fitRefusal(gain, residual, rmsOf(force));
  if (!refusal.empty()) return refusal;
  remember();
  gain_ = gain;
  residual_ = residual;
  fitted_ = points();
  ++changes_;
  outcome_ = std::string("calibrated: ") + (whole ? "whole matrix" : "gain of each axis") + " from " +
             std::to_string(points()) + " points, residual " + axesText(Eigen::VectorXd::Constant(1, residual)) +
             " rms";
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

std::string ForceReadout::clear() {
  if (averaging()) return "an average is under way";
  remember();
  points_.clear();
  gain_.setIdentity();
  residual_ = 0;
  fitted_ = 0;
  ++changes_;
  outcome_ = "calibration cleared";
  return "";
}

std::string ForceReadout::undo() {
  if (averaging()) return "an average is under way";
  if (steps_.empty()) return "there is no step of this session to take back";
  const Step step = std::move(steps_.back());
  steps_.pop_back();
  if (step.tare != tare_ || step.gain != gain_) ++changes_;
  tare_ = step.tare;
  gain_ = step.gain;
  points_ = step.points;
  residual_ = step.residual;
  fitted_ = step.fitted;
  outcome_ = "the last step is taken back; " + std::to_string(points()) + " calibration points";
  return "";
}

SensorCalibration ForceReadout::calibration() const { return {tare_, gain_, fitted_, residual_}; }

void ForceReadout::restore(const SensorCalibration& calibration) {
  tare_ = calibration.tare;
  gain_ = calibration.gain;
  residual_ = calibration.residual;
  fitted_ = calibration.points;
}

}  // namespace microinjection
