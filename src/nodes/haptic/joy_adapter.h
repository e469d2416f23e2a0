#pragma once

#include <sensor_msgs/Joy.h>

#include <string>
#include <utility>
#include <vector>

#include "nodes/haptic/haptic_adapter.h"
#include "operation/teleoperation/rate_input.h"

namespace microinjection {

struct JoyConfig {
  std::string topic = "joy";
  double timeout = 0.2;  ///< s, past which the joystick is stale: its driver must repeat its messages
  RateInputConfig stick;
  std::vector<std::pair<std::string, int>> commands;  ///< state command and the button that sends it

  static JoyConfig read(ConfigReader& reader);
};

/// A joystick, gamepad or space mouse (sensor_msgs/Joy) for the bridge's rate mode. It renders no
/// force. A driver whose buttons toggle at each press (~sticky_buttons of joy_node) is refused: a
/// dead-man button would stay pressed when it is let go.
class JoyAdapter : public HapticAdapter {
 public:
  using Config = JoyConfig;
  JoyAdapter(Cycle& cycle, const JoyConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  std::string invalidReason() const override;
  void render(const Eigen::Vector3d&, const Cycle::Tick&) override {}
  std::vector<std::string> takeCommands() override { return std::exchange(commands_, {}); }

 private:
  void receive(const sensor_msgs::Joy& joy);
  std::string stickyDriver() const;

  Bus& bus_;
  JoyConfig config_;
  RateInput stick_;
  Input<sensor_msgs::Joy>& joy_;
  std::vector<int> last_buttons_;
  bool asked_ = false;  ///< whether the buttons of this driver are sticky, since it began to publish
  std::string sticky_;  ///< the node whose are
  std::vector<std::string> commands_;
};

}  // namespace microinjection
