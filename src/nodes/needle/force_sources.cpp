#include "nodes/needle/force_sources.h"

#include <utility>

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

/// Wrench of a two-axis reading in the sensor's frame: z axial, x lateral. The torque is not
/// measured and 0.
geometry_msgs::WrenchStamped twoAxes(const Eigen::Vector2d& reading, const ros::Time& stamp, const std::string& frame) {
  return toWrench({reading[1], 0, reading[0]}, stamp, frame);
}

}  // namespace

SimulatedForceSource::SimulatedForceSource(Cycle& cycle, double timeout, const ForceSensorConfig& config,
                                           std::string frame, const Eigen::Isometry3d& tip_from_sensor)
    : model_(config),
      range_(config.range),
      frame_(std::move(frame)),
      sensor_from_tip_(tip_from_sensor.linear().transpose()),
      force_(cycle.input<geometry_msgs::WrenchStamped>("cell/predicted_cf", InputPhase::kDrives, timeout)),
      needle_(cycle.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kSampled, timeout)) {}

std::optional<ForceSource::Signal> SimulatedForceSource::read(const Cycle::Tick& tick) {
  const auto pose = validPose(needle_.get(tick.now));
  const auto* message = force_.get(tick.now);
  const auto force = pose ? validForce(message, pose->linear()) : std::nullopt;
  invalid_reason_ = force ? "" : pose ? "no valid force" : "no valid needle pose";
  if (!force) return std::nullopt;
  const Eigen::Vector3d at_sensor = sensor_from_tip_ * (pose->linear().transpose() * *force);
  const Eigen::Vector2d reading = model_.sample({at_sensor.z(), at_sensor.x()}, tick.dt);
  return Signal{reading, message->header.stamp, twoAxes(reading, message->header.stamp, frame_)};
}

SerialForceSource::SerialForceSource(const SerialPortConfig& port, const VoltReadingConfig& config,
                                     const Eigen::Vector2d& overload, double timeout, std::string frame)
    : device_(std::make_unique<SerialPort>(port), config),
      overload_(overload),
      timeout_(timeout),
      frame_(std::move(frame)) {}

std::optional<ForceSource::Signal> SerialForceSource::read(const Cycle::Tick& tick) {
  device_.step(tick.now.toSec());
  const auto& reading = device_.reading();
  const bool fresh = reading && tick.now.toSec() - reading->time <= timeout_;
  invalid_reason_ = fresh ? "" : device_.errorText().empty() ? "no good line from the sensor" : device_.errorText();
  if (!fresh || std::exchange(seen_, device_.goodLines()) == device_.goodLines()) return std::nullopt;
  overload_.check(reading->force);
  return Signal{reading->force, tick.now, twoAxes(reading->force, tick.now, frame_)};
}

void SerialForceSource::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("lines read", device_.goodLines());
  status.add("lines skipped as bad", device_.badLines());
}

TopicForceSource::TopicForceSource(Cycle& cycle, double timeout, const Eigen::Vector2d& overload)
    : frames_(cycle.bus()),
      overload_(overload),
      wrench_(cycle.input<geometry_msgs::WrenchStamped>("force_sensor/device_cf", InputPhase::kDrives, timeout)) {}

std::optional<ForceSource::Signal> TopicForceSource::read(const Cycle::Tick& tick) {
  const auto message = wrench_.takeUpdates();
  const auto force = finiteForce(wrench_.get(tick.now));
  if (!force || !isWithin(toVector(wrench_.get(tick.now)->wrench.torque), kLargestForce)) {
    invalid_reason_ = "no valid wrench on force_sensor/device_cf";
    return std::nullopt;
  }
  if (!message) return std::nullopt;
  const auto pose = frames_.find(kTipFrame, message->header.frame_id);
  invalid_reason_ = pose ? "" : "tf has no transform from frame '" + message->header.frame_id + "' to " + kTipFrame;
  if (!pose) return std::nullopt;
  // The same force about another point: the torque gains arm x force.
  Signal signal{Eigen::VectorXd(6), message->header.stamp, *message};
  const Eigen::Vector3d at_tip = pose->linear() * *force;
  signal.values << at_tip, pose->linear() * toVector(message->wrench.torque) + pose->translation().cross(at_tip);
  overload_.check({at_tip.z(), at_tip.head<2>().norm()});
  return signal;
}

}  // namespace microinjection
