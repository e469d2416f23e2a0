#include "nodes/haptic/joy_adapter.h"

namespace microinjection {

JoyConfig JoyConfig::read(ConfigReader& reader) {
  JoyConfig config;
  reader.text("topic", config.topic);
  reader.number("timeout", config.timeout, Range::positive());
  config.stick = RateInputConfig::read(reader);
  ConfigReader commands = reader.section("commands");
  for (const char* command :
       {"enable", "disable", "inject", "home", "hold", "approach", "indent", "aspirate", "withdraw", "release"}) {
    int button = -1;
    commands.integer(command, button, Range::closed(-1, 63));
    if (button >= 0) config.commands.emplace_back(command, button);
  }
  return config;
}

JoyAdapter::JoyAdapter(Cycle& cycle, const JoyConfig& config)
    : bus_(cycle.bus()),
      config_(config),
      stick_(config.stick),
      joy_(cycle.input<sensor_msgs::Joy>(config.topic, InputPhase::kSampled, config.timeout)) {
  joy_.onMessage([this](const sensor_msgs::Joy& joy, const ros::Time&) { receive(joy); });
}

void JoyAdapter::receive(const sensor_msgs::Joy& joy) {
  for (const auto& [command, button] : config_.commands) {
    const auto index = static_cast<std::size_t>(button);
    const bool before = index >= last_buttons_.size() || last_buttons_[index] != 0;
    if (index < joy.buttons.size() && joy.buttons[index] != 0 && !before) commands_.push_back(command);
  }
  last_buttons_ = joy.buttons;
}

/// The node that publishes the joystick with sticky buttons; empty: there is none.
std::string JoyAdapter::stickyDriver() const {
  for (const std::string& node : bus_.publishersOf(config_.topic)) {
    const YAML::Node sticky = bus_.parameter(node + "/sticky_buttons");
    if (sticky && sticky.IsScalar() && sticky.as<bool>(false)) return node;
  }
  return "";
}

std::optional<HandReading> JoyAdapter::read(const Cycle::Tick& tick) {
  const sensor_msgs::Joy* joy = joy_.get(tick.now);
  if (!std::exchange(asked_, joy != nullptr) && joy) sticky_ = stickyDriver();
  const auto stick = joy && sticky_.empty() ? stick_.read(joy->axes, joy->buttons, tick.now.toSec()) : std::nullopt;
  if (!stick) {
    stick_.reset();
    return std::nullopt;
  }
  // The stamp is the present time: the joystick keeps its position until it publishes a change.
  return HandReading{stick->position, tick.now, false, stick->operator_present};
}

std::string JoyAdapter::invalidReason() const {
  if (!sticky_.empty()) {
    return sticky_ + "/sticky_buttons is true: the dead-man button would stay pressed when it is let go; start " +
           sticky_ + " with _sticky_buttons:=false";
  }
  if (!stick_.repeats()) return "";
  return "the stick repeats one deflection: a hand changes it now and then; is the receiver's link lost? Let it go "
         "first";
}

}  // namespace microinjection
