#pragma once

#include <string>
#include <utility>
#include <vector>

#include "nodes/haptic/haptic_adapter.h"
#include "nodes/haptic/raw_terminal.h"
#include "nodes/haptic/session_state.h"
#include "operation/teleoperation/goal_hand.h"
#include "operation/teleoperation/terminal_keys.h"

namespace microinjection {

struct KeyboardConfig {
  GoalHandConfig hand;
  double step = 1e-3;  ///< m of the hand per key

  static KeyboardConfig read(ConfigReader& reader);
};

/// The keyboard of the node's terminal: arrows and page keys move the hand while they are held,
/// letters are the operator's commands. A line below shows the state and the force.
class KeyboardAdapter : public HapticAdapter {
 public:
  using Config = KeyboardConfig;
  KeyboardAdapter(Cycle& cycle, const KeyboardConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::vector<std::string> takeCommands() override { return std::exchange(commands_, {}); }
  bool wantsToEnd() const override { return ended_ || terminal_.closed(); }

 private:
  void execute(const std::string& key);

  KeyboardConfig config_;
  GoalHand hand_;
  TerminalKeys keys_;
  SessionState session_;
  std::vector<std::string> commands_;
  ros::Time shown_;
  bool ended_ = false;
  RawTerminal terminal_;
};

}  // namespace microinjection
