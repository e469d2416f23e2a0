#include "operation/control/withdrawal_guard.h"

#include <algorithm>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kReleased = 0.9;     ///< of a force limit, below which it ends
constexpr double kReleaseTime = 0.1;  ///< s
constexpr double kPlay = 0.05;        ///< of depth_limit, which follows the cell's size

}  // namespace

WithdrawalGuard::WithdrawalGuard(const GuardConfig& config)
    : config_(config), lower_(config), play_(kPlay * config.depth_limit) {
  lower_.force_limit *= kReleased;
  lower_.lateral_force_limit *= kReleased;
}

void WithdrawalGuard::reset() {
  reason_.clear();
  below_ = owed_ = withdrawn_ = 0;
}

std::string WithdrawalGuard::beyond(const GuardConfig& limits, const Eigen::Vector3d& force,
                                    const Eigen::Vector3d& axis, double depth) const {
  std::string reason = forceGuard(limits, force, axis);
  return reason.empty() ? depthGuard(limits, depth) : reason;
}

bool WithdrawalGuard::step(const Eigen::Vector3d& force, const Eigen::Vector3d& axis, double depth, double dt) {
  const std::string now = beyond(config_, force, axis, depth);
  if (!now.empty()) {
    const bool begins = !active();
    if (begins) withdrawn_ = 0;
    reason_ = now;
    below_ = 0;
    return begins;
  }
  if (!active()) return false;
  below_ = beyond(lower_, force, axis, depth).empty() ? below_ + dt : 0;
  if (below_ >= kReleaseTime) reason_.clear();
  return false;
}

double WithdrawalGuard::followed(double motion) {
  if (motion > 0) {
    const double paid = std::min(motion, owed_);
    owed_ -= paid;
    return motion - paid;
  }
  if (!active()) return motion;
  owed_ = std::min(owed_ - motion, play_);
  return 0;
}

std::string WithdrawalGuard::withdraw(double way) {
  if (!active() || way <= 0) return "";
  withdrawn_ += way;
  if (withdrawn_ <= config_.depth_limit) return "";
  std::ostringstream text;
  text << reason_ << ", and still after the needle was withdrawn by depth_limit = " << config_.depth_limit
       << " m: this is no force of the cell. Check and tare the force sensor, then resume, or home";
  return text.str();
}

}  // namespace microinjection
