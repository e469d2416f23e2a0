#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/TimeReference.h>

#include <memory>
#include <string>
#include <vector>

#include "base/busy_report.h"
#include "cell_microinjection/StringStamped.h"
#include "hardware/manipulator/command_authority.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/needle_state.h"
#include "nodes/needle/manipulator_setup.h"
#include "nodes/runtime/command_log.h"
#include "nodes/runtime/command_source.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/network_monitor.h"

namespace microinjection {

/// Receives the commands of the micromanipulator's topics (nodes/micromanipulator_node.h), refuses
/// invalid ones with a reason, and keeps the operating state.
class NeedleCommands {
 public:
  struct Options {
    bool allow_network = false;  ///< false: a real rig is not enabled while others can reach this machine
    bool auto_enable = true;     ///< false: it begins DISABLED
    bool streamed = true;        ///< a controller streams set-points, so that their absence is said
    std::string moved;           ///< what is commanded, for texts
  };
  /// All references outlive this.
  NeedleCommands(Cycle& cycle, const MicromanipulatorConfig& config, ManipulatorSetup& rig, Micromanipulator& model,
                 const Options& options);

  /// Call before the model's step: checks device, senders and network, and executes the newest
  /// servo_cp.
  void step(const Cycle::Tick& tick);
  /// Call after the model's step, before the state is published.
  void endStep();
  /// Call after the model's step. Returns this step's is_busy.
  bool isBusy(const Cycle::Tick& tick);
  /// See BusyReport::pending.
  bool busyIsPending() const { return busy_.pending(); }

  const NeedleState& state() const { return state_; }
  /// The device's time (s), which does not follow a clock that is set back.
  double time() const { return now_.toSec() + set_back_; }
  bool moves() const;
  /// Whether a state command or a fault was received since the last call. Each is answered with the
  /// state.
  bool takeStateCommandReceived();
  std::string unavailableReason() const;  ///< why motion commands are refused here; else empty
  std::string streamHold() const;         ///< why a stream of commands moves nothing now; else empty
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void subscribe(const Options& options);
  void subscribeFaults();
  void onVelocity(const geometry_msgs::TwistStamped& message, const CommandSource& source);
  void onMove(const geometry_msgs::PoseStamped& message, const CommandSource& source);
  void onState(const cell_microinjection::StringStamped& message, const CommandSource& source);
  void onFault(const std::string& fault);
  std::string executeState(const cell_microinjection::StringStamped& message, const CommandSource& source);
  void change(StateCommand command, bool fault);
  void executeServo(const Cycle::Tick& tick);
  double age(const ros::Time& stamp) const;
  template <typename Execute>
  void command(const std::string& name, const std::string& sender, const Execute& execute);
  void authorize(const std::string& sender);
  void checkNetwork();
  NeedleState::Conditions conditions() const;

  Cycle& cycle_;
  const MicromanipulatorConfig& config_;
  ManipulatorSetup& rig_;
  Micromanipulator& model_;
  Input<geometry_msgs::PoseStamped>& servo_;
  Output<sensor_msgs::TimeReference>& trace_;
  RepeatedCommands repeated_;
  std::vector<Subscription> subscriptions_;
  NeedleState state_;
  CommandAuthority authority_;
  CommandLog log_;
  BusyReport busy_;
  std::string mover_;                        ///< node that commanded the move under way
  std::string abort_reason_;                 ///< of the model's motion, as logged
  std::unique_ptr<NetworkMonitor> network_;  ///< null when the network is not checked
  bool exposed_ = false;                     ///< a real rig, and others can reach this machine
  bool admitted_ = false;                    ///< enabled while no other could reach this machine
  bool master_lost_ = false;
  bool state_command_received_ = false;
  ros::Time now_;
  double set_back_ = 0;  ///< s, sum of the clock's steps back
};

}  // namespace microinjection
