#include "operation/control/guards.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/plausible.h"

namespace microinjection {
namespace {

constexpr double kSpeedWindow = 0.02;  ///< s
constexpr double kSlack = 1e-6;        ///< m, added to the following error for encoder steps and thermal drift

/// Force over its limit that no cell exerts: the limit is twice the puncture force, and a needle that runs into glass
/// at the speed limit is stopped earlier.
constexpr double kNoCell = 10;
constexpr double kContradicted = 100;  ///< force over the predicted one, which no error of the cell's model explains
constexpr double kFelt = 1e-9;         ///< N, from where on the model is in contact

/// Reason when a value exceeds its limit, else empty. `of` follows `what` in the text.
std::string beyond(const char* what, double value, double limit, const char* unit, const char* of = "") {
  if (value <= limit) return "";
  std::ostringstream text;
  text << what << of << ' ' << value << ' ' << unit << ", allowed " << limit << ' ' << unit;
  return text.str();
}

}  // namespace

GuardConfig GuardConfig::read(ConfigReader& reader) {
  GuardConfig config;
  reader.number("speed_limit", config.speed_limit, Range::positive());
  reader.number("jump_limit", config.jump_limit, Range::positive());
  reader.number("lag_limit", config.lag_limit, Range::positive());
  reader.number("tracking_limit", config.tracking_limit, Range::positive());
  reader.number("needle_speed_limit", config.needle_speed_limit, Range::positive());
  reader.number("force_limit", config.force_limit, Range::positive());
  reader.number("lateral_force_limit", config.lateral_force_limit, Range::positive());
  reader.number("depth_limit", config.depth_limit, Range::positive());
  reader.number("time_limit", config.time_limit, Range::positive());
  return config;
}

double NeedleSpeed::step(const Eigen::Vector3d& position, double dt) {
  for (Past& past : past_) past.age += dt;
  while (past_.size() > 1 && past_[1].age >= kSpeedWindow) past_.pop_front();
  const bool enough = !past_.empty() && past_.front().age >= kSpeedWindow;
  const double speed = enough ? (position - past_.front().position).norm() / past_.front().age : 0;
  past_.push_back({position, 0});
  return speed;
}

double followingErrorLimit(const GuardConfig& config, double lag) {
  return 2 * std::min(config.lag_limit, config.speed_limit * lag) + kSlack;
}

std::string rigFault(const GuardConfig& config, const Eigen::Vector3d& needle, const Eigen::Vector3d& setpoint,
                     double speed) {
  const double error = (needle - setpoint).norm();
  if (error > config.tracking_limit) {
    std::ostringstream text;
    text << "the needle is " << error << " m from its set-point, allowed " << config.tracking_limit << " m";
    return text.str();
  }
  return beyond("the needle moves at", speed, config.needle_speed_limit, "m/s");
}

std::string forceGuard(const GuardConfig& config, const Eigen::Vector3d& force, const Eigen::Vector3d& axis) {
  const double along = force.dot(axis);
  std::string reason = beyond("force along the pipette", std::abs(along), config.force_limit, "N");
  if (!reason.empty()) return reason;
  return beyond("force across the pipette", (force - along * axis).norm(), config.lateral_force_limit, "N");
}

std::string sensorFault(const GuardConfig& config, const Eigen::Vector3d& force, const Eigen::Vector3d& axis,
                        const std::optional<Eigen::Vector3d>& predicted) {
  const double along = force.dot(axis), across = (force - along * axis).norm();
  const double of_limit = std::max(std::abs(along) / config.force_limit, across / config.lateral_force_limit);
  const double size = force.norm(), model = predicted ? predicted->norm() : 0;
  const bool contradicted = of_limit > 1 && model >= kFelt && size > kContradicted * model;
  if (of_limit <= kNoCell && !contradicted) return "";
  std::ostringstream text;
  text << "the sensor's force of " << size << " N is ";
  std::string slip = unitSlip(of_limit, "N");
  if (of_limit > kNoCell) text << of_limit << " times its limit, which no cell exerts";
  if (contradicted) {
    text << (of_limit > kNoCell ? ", and " : "") << size / model << " times the predicted " << model << " N";
    slip = unitSlip(size / model, "N");
  }
  text << ": a fault of the sensor" << (slip.empty() ? "" : ", " + slip);
  return text.str();
}

std::string depthGuard(const GuardConfig& config, double depth) {
  return beyond("depth past the touch", depth, config.depth_limit, "m");
}

std::string timeGuard(const GuardConfig& config, const char* state, double time) {
  return beyond("time in state ", time, config.time_limit, "s", state);
}

}  // namespace microinjection
