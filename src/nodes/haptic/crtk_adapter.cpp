#include "nodes/haptic/crtk_adapter.h"

#include <limits>

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();

/// Whether a button is held down. Returns `none` without such a button, `unknown` without a valid
/// message about it.
bool heldDown(const Input<sensor_msgs::Joy>* input, int index, const ros::Time& now, bool none, bool unknown) {
  if (!input) return none;
  const sensor_msgs::Joy* joy = input->get(now);
  return joy && index < static_cast<int>(joy->buttons.size()) ? joy->buttons[index] == 1 : unknown;
}

}  // namespace

CrtkButton CrtkButton::read(ConfigReader reader, const std::string& topic) {
  CrtkButton button{topic};
  reader.text("topic", button.topic);
  reader.integer("index", button.index, Range::closed(0, 63));
  return button;
}

CrtkConfig CrtkConfig::read(ConfigReader& reader) {
  CrtkConfig config;
  reader.text("device", config.device);
  reader.choice("position_type", config.position_type, {"pose", "transform"});
  reader.text("force", config.force);
  reader.text("state", config.state);
  reader.number("timeout", config.timeout, Range::positive());
  reader.number("button_timeout", config.button_timeout, Range::nonNegative());
  config.clutch = CrtkButton::read(reader.section("clutch"), "clutch");
  config.operator_present = CrtkButton::read(reader.section("operator_present"), "operator_present");
  config.settings = DeviceSetting::readAll(reader, "settings");
  return config;
}

CrtkAdapter::CrtkAdapter(Cycle& cycle, const CrtkConfig& config)
    : config_(config),
      clutch_(subscribe(cycle, config.clutch)),
      operator_present_(subscribe(cycle, config.operator_present)),
      force_(cycle.output<geometry_msgs::WrenchStamped>(deviceTopic(config.device, config.force))),
      settings_(cycle.bus(), config.device, config.settings),
      receiver_(cycle, force_.publisher) {
  if (!config.state.empty()) {
    state_ = &cycle.input<cell_microinjection::OperatingState>(deviceTopic(config.device, config.state),
                                                               InputPhase::kSampled, kForEver);
  }
  const std::string topic = deviceTopic(config.device, "measured_cp");
  if (config.position_type == "pose") {
    pose_ = &cycle.input<geometry_msgs::PoseStamped>(topic, InputPhase::kDrives, config.timeout);
    receiver_.monitor(*pose_);
  } else {
    transform_ = &cycle.input<geometry_msgs::TransformStamped>(topic, InputPhase::kDrives, config.timeout);
    receiver_.monitor(*transform_);
  }
}

Input<sensor_msgs::Joy>* CrtkAdapter::subscribe(Cycle& cycle, const CrtkButton& button) const {
  if (button.topic.empty()) return nullptr;
  const double timeout = config_.button_timeout > 0 ? config_.button_timeout : kForEver;
  return &cycle.input<sensor_msgs::Joy>(deviceTopic(config_.device, button.topic), InputPhase::kSampled, timeout);
}

std::optional<CrtkAdapter::Position> CrtkAdapter::position(const ros::Time& now) const {
  if (pose_) {
    const auto* pose = pose_->get(now);
    if (!pose) return std::nullopt;
    return Position{pose->header.stamp, pose->header.frame_id, toVector(pose->pose.position)};
  }
  const auto* transform = transform_->get(now);
  if (!transform) return std::nullopt;
  return Position{transform->header.stamp, transform->header.frame_id, toVector(transform->transform.translation)};
}

std::string CrtkAdapter::noForceReason(const ros::Time& now) {
  if (!ready_) return receiver_.driver() + " has not received its settings " + settings_.missing();
  if (!receiver_.isConnected()) return receiver_.reason();
  const auto* state = state_ ? state_->get(now) : nullptr;
  if (!state_ || (state && state->state == "ENABLED" && state->is_homed)) return "";
  if (!state) return "no valid operating state on " + state_->topic;
  return "it accepts no force: " + state->state + (state->is_homed ? "" : ", not homed");
}

std::optional<HandReading> CrtkAdapter::read(const Cycle::Tick& tick) {
  const auto measured = position(tick.now);
  // Also while the device is stale: a restarted driver needs its settings first, too.
  ready_ = !receiver_.driver().empty() && settings_.received(receiver_.driver(), tick.now);
  if (!measured || !isWithin(measured->position, kLargestHandDistance)) {
    reason_ = measured ? "its position is not finite, or too far away" : "";
    // A driver that publishes only changes may have missed the last one.
    if (!measured && operator_present_ && config_.button_timeout <= 0) operator_present_->invalidate();
    return std::nullopt;
  }
  frame_ = measured->frame;
  reason_ = noForceReason(tick.now);
  if (!reason_.empty()) return std::nullopt;
  HandReading reading;
  reading.position = measured->position;
  reading.stamp = measured->stamp;
  // Without a message, the clutch of a driver that publishes only changes counts as released, and
  // so does a dead-man switch.
  const bool clutch_unknown = clutch_ && !clutch_->received.isZero();
  reading.clutch = heldDown(clutch_, config_.clutch.index, tick.now, false, clutch_unknown);
  reading.operator_present = heldDown(operator_present_, config_.operator_present.index, tick.now, true, false);
  return reading;
}

/// A device holds the last force for ever, which may be an earlier adapter's: it receives zero
/// before its first message. A device with settings receives no force before them, not even zero:
/// in an arm of dVRK the first force ends the position control that holds it, and without gravity
/// compensation it would fall.
void CrtkAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick& tick) {
  if (ready_ || config_.settings.empty()) force_.publish(toWrench(force, tick.now, frame_));
}

}  // namespace microinjection
