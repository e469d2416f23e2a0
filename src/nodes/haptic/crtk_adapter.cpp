#include "nodes/haptic/crtk_adapter.h"

#include <limits>

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();

/// `none`: where there is no such button; `unknown`: where it has said nothing, or nothing of this one.
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
      lockstep_(cycle.lockstep()),
      clutch_(listenTo(cycle, config.clutch)),
      operator_present_(listenTo(cycle, config.operator_present)),
      force_(cycle.output<geometry_msgs::WrenchStamped>(deviceTopic(config.device, config.force))),
      settings_(cycle.node(), config.device, config.settings),
      receiver_(force_.publisher, !lockstep_) {
  if (!config.state.empty()) {
    state_ = &cycle.input<cell_microinjection::OperatingState>(deviceTopic(config.device, config.state),
                                                               InputPhase::kPreviousTick, kForEver);
  }
  const std::string topic = deviceTopic(config.device, "measured_cp");
  if (config.position_type == "pose") {
    pose_ = &cycle.input<geometry_msgs::PoseStamped>(topic, InputPhase::kThisTick, config.timeout);
    receiver_.watch(*pose_);
  } else {
    transform_ = &cycle.input<geometry_msgs::TransformStamped>(topic, InputPhase::kThisTick, config.timeout);
    receiver_.watch(*transform_);
  }
}

Input<sensor_msgs::Joy>* CrtkAdapter::listenTo(Cycle& cycle, const CrtkButton& button) const {
  if (button.topic.empty()) return nullptr;
  const double timeout = config_.button_timeout > 0 ? config_.button_timeout : kForEver;
  return &cycle.input<sensor_msgs::Joy>(deviceTopic(config_.device, button.topic), InputPhase::kPreviousTick, timeout);
}

std::optional<CrtkAdapter::Position> CrtkAdapter::position(const ros::Time& now) const {
  if (pose_) {
    const auto* pose = pose_->get(now);
    if (!pose) return std::nullopt;
    const auto& p = pose->pose.position;
    return Position{pose->header.stamp, pose->header.frame_id, {p.x, p.y, p.z}};
  }
  const auto* transform = transform_->get(now);
  if (!transform) return std::nullopt;
  const auto& p = transform->transform.translation;
  return Position{transform->header.stamp, transform->header.frame_id, {p.x, p.y, p.z}};
}

std::string CrtkAdapter::whyUnfelt(const ros::Time& now) {
  if (!ready_) return receiver_.driver() + " has not yet heard its settings " + settings_.missing();
  if (!receiver_.feels()) return receiver_.why();
  const auto* state = state_ ? state_->get(now) : nullptr;
  if (!state_ || (state && state->state == "ENABLED" && state->is_homed)) return "";
  if (!state) return "it has not told its state, " + state_->topic;
  return "it takes no force: " + state->state + (state->is_homed ? "" : ", not homed");
}

std::optional<HandReading> CrtkAdapter::read(const Cycle::Tick& tick) {
  const auto told = position(tick.now);
  // Also while it is silent: one that was started again must be told first, too.
  ready_ = !receiver_.driver().empty() && settings_.taken(receiver_.driver(), tick.now);
  if (!told || !isWithin(told->position, kLargestHandDistance)) {
    reason_ = told ? "its position is not finite, or too far away" : "";
    // Of a driver that tells changes only: it may have missed to tell the last one.
    if (!told && operator_present_ && config_.button_timeout <= 0) operator_present_->invalidate();
    return std::nullopt;
  }
  frame_ = told->frame;
  reason_ = whyUnfelt(tick.now);
  if (!reason_.empty()) return std::nullopt;
  HandReading reading;
  reading.position = told->position;
  reading.stamp = told->stamp;
  // A clutch that says nothing counts as released where it tells changes only, a dead-man as let go.
  const bool clutch_unknown = clutch_ && !clutch_->received.isZero();
  reading.clutch = heldDown(clutch_, config_.clutch.index, tick.now, false, clutch_unknown);
  reading.operator_present = heldDown(operator_present_, config_.operator_present.index, tick.now, true, false);
  return reading;
}

/// A device holds the last force for ever, which may be that of an adapter before this one: it gets zero before
/// anything is known of it. One that needs settings gets nothing before it has them, not even zero: in an arm of dVRK
/// the first force ends the position control that holds it, so that without gravity compensation it would fall.
void CrtkAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick& tick) {
  if (ready_ || config_.settings.empty()) force_.publish(toWrench(force, tick.now, frame_));
}

}  // namespace microinjection
