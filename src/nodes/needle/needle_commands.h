#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/TimeReference.h>

#include <memory>
#include <string>
#include <vector>

#include "base/busy_report.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/needle/rig_device.h"
#include "nodes/runtime/command_log.h"
#include "nodes/runtime/command_source.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/network_monitor.h"
#include "rig/manipulator/command_authority.h"
#include "rig/manipulator/micromanipulator.h"
#include "rig/manipulator/needle_state.h"

namespace microinjection {

/// What may move the needle: takes the commands of the micromanipulator's topics, refuses with the reason what it
/// cannot trust, and keeps the operating state. Which topics: nodes/micromanipulator_node.h.
class NeedleCommands {
 public:
  /// All outlive this. @param allow_network  false: a real rig is not enabled while others can reach this machine
  NeedleCommands(Cycle& cycle, const MicromanipulatorConfig& config, RigDevice& rig, Micromanipulator& model,
                 bool allow_network);

  /// Before the model's step: looks at what surrounds the needle and obeys the newest servo_cp.
  void step(const Cycle::Tick& tick);
  /// After the model's step: what is_busy says in this step.
  bool isBusy(const Cycle::Tick& tick);
  /// See BusyReport::pending.
  bool busyIsPending() const { return busy_.pending(); }

  const NeedleState& state() const { return state_; }
  /// As the device has it: a clock that is set back does not take it along. s
  double time() const { return now_.toSec() + set_back_; }
  bool moves() const;
  /// Whether a state command or a fault was heard since the last call: they are answered.
  bool takeAnswer();
  std::string unavailableReason() const;  ///< why motion commands are refused here; else empty
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void subscribe();
  void subscribeFaults();
  void onVelocity(const geometry_msgs::TwistStamped& message, const CommandSource& source);
  void onMove(const geometry_msgs::PoseStamped& message, const CommandSource& source);
  void onState(const cell_microinjection::StringStamped& message, const CommandSource& source);
  void onFault(const std::string& fault);
  std::string executeState(const cell_microinjection::StringStamped& message, const CommandSource& source);
  void change(StateCommand command, bool fault);
  void executeServo(const Cycle::Tick& tick);
  double age(const ros::Time& stamp) const;
  template <typename Obey>
  void command(const std::string& name, const std::string& sender, const Obey& execute);
  void authorize(const std::string& sender);
  void checkNetwork();
  NeedleState::Conditions conditions() const;

  Cycle& cycle_;
  const MicromanipulatorConfig& config_;
  RigDevice& rig_;
  Micromanipulator& model_;
  Input<geometry_msgs::PoseStamped>& servo_;
  Output<sensor_msgs::TimeReference>& trace_;
  RepeatedCommands repeated_;
  std::vector<ros::Subscriber> subscribers_;
  NeedleState state_;
  CommandAuthority authority_;
  CommandLog log_;
  BusyReport busy_;
  std::string mover_;                        ///< node that commanded the move under way
  std::string logged_abort_;                 ///< of the model's motion, as logged
  std::unique_ptr<NetworkMonitor> network_;  ///< null where it does not matter who can reach this machine
  bool exposed_ = false;                     ///< a real rig, and others can reach this machine
  bool admitted_ = false;                    ///< enabled while nobody else could reach this machine
  bool master_lost_ = false;
  bool answer_ = false;
  ros::Time now_;
  double set_back_ = 0;  ///< s, that the clock was
};

}  // namespace microinjection
