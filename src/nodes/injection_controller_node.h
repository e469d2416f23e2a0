#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "base/busy_report.h"
#include "base/repetition.h"
#include "cell_microinjection/CellEstimate.h"
#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/InterfacePosition.h"
#include "cell_microinjection/ManipulatorAbilities.h"
#include "cell_microinjection/OperatingState.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/injection/holder_link.h"
#include "nodes/injection/injection_action.h"
#include "nodes/injection/injector_link.h"
#include "nodes/injection/manipulator_watch.h"
#include "nodes/injection/witnesses.h"
#include "nodes/runtime/command_log.h"
#include "nodes/runtime/command_source.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/force_liveness.h"
#include "nodes/runtime/loop_state.h"
#include "operation/control/injection_controller.h"

namespace microinjection {

/// Controls the needle, simulated or real. Holds it when an input is invalid.
///
/// In:  /teleop/servo_cp (PoseStamped, `world`; with mode manual), /needle/measured_cp
///      (PoseStamped), /cell/predicted_cf or /force_sensor/measured_cf (WrenchStamped),
///      /controller/state_command (StringStamped), /needle/abilities (ManipulatorAbilities, to
///      drive a slow rig slowly), /needle/operating_state and /needle/loop_state (does the rig
///      follow?), the other force, /cell/parameters and /cell/contact (see Witnesses), /injector/state,
///      /needle/interface (InterfacePosition, what suction has drawn in, where somebody sees it), /cell/estimate
///      (CellEstimate, the expected puncture); the action Inject on /controller/inject
///      With a holder those of HolderLink
/// Out: /needle/servo_cp (PoseStamped, `world`), /controller/operating_state (OperatingState,
///      latched, on change and after each state_command), /controller/injection_state
///      (InjectionStatus, latched, on change and ten times a second), /injector/pulse,
///      /injector/stop; with a holder those of HolderLink
///
/// Parameters: config/injection_controller.yaml
class InjectionControllerNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit InjectionControllerNode(Bus& bus);

 private:
  struct Parameters {
    double rate = 1000;
    double input_timeout = 0.05;
    std::string force_source = "predicted";
    bool quiet_sensor = false;  ///< of the session, sensor/quiet
    bool auto_enable = false;
    bool injector = true;
    InjectionControllerConfig model;
    static Parameters read(const Bus& bus);
  };

  void subscribeCommands();
  void receiveCommand(const cell_microinjection::StringStamped& message, bool latched, bool repeated);
  void execute(const std::string& command);
  void adaptTo(const cell_microinjection::ManipulatorAbilities& rig);
  void receiveEstimate(const cell_microinjection::CellEstimate& message);
  void watchNeedle(const geometry_msgs::PoseStamped& needle, const ros::Time& now);
  bool feelsContact() const;
  std::optional<ExpectedPuncture> expectedPuncture(const ros::Time& now) const;
  void step(const Cycle::Tick& tick);
  void logNotice();
  void publishState(const ros::Time& now);
  void publishInjection(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  InjectionController model_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>* target_ = nullptr;  ///< null when the controller moves by itself
  Input<geometry_msgs::PoseStamped>& needle_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Input<cell_microinjection::InterfacePosition>& interface_;
  Output<geometry_msgs::PoseStamped>& setpoint_;
  Output<cell_microinjection::InjectionStatus>& injection_;
  std::unique_ptr<InjectorLink> injector_;  ///< null without an injector
  std::unique_ptr<HolderLink> holder_;      ///< null without a holder
  ForceLiveness force_lives_;
  Repetition<Eigen::Vector3d> needle_poses_;      ///< m, exposed to s over needle_patience_
  ros::Time watched_;                             ///< the last of them
  std::optional<Eigen::Vector3d> setpoint_then_;  ///< m, when it changed; empty: the rig was not commanded
  std::optional<Eigen::Vector3d> commanded_;      ///< m, the last set-point; empty: the rig is not commanded
  std::optional<Eigen::Vector3d> rig_setpoint_;   ///< m, which the rig has accepted; empty: it does not tell
  ros::Time rig_setpoint_heard_;
  double needle_patience_ = 0.2;  ///< s
  double needle_step_ = 0;        ///< m, the rig's resolution
  ManipulatorWatch rig_;
  Witnesses witnesses_;
  LoopStatePublisher loop_state_;
  InjectionAction action_;
  RepeatedCommands repeated_;
  CommandLog log_;
  BusyReport busy_;
  bool state_command_received_ = false;
  Subscription commands_, abilities_, estimates_, rig_setpoints_;
  std::optional<ExpectedPuncture> expected_;  ///< by the estimator
  ros::Time estimated_;                       ///< its time
  bool adapted_ = false;                      ///< to a rig's abilities
  Publisher<cell_microinjection::OperatingState> state_;
  cell_microinjection::OperatingState last_published_state_;
  cell_microinjection::InjectionStatus last_published_injection_;
  std::string logged_notice_;  ///< the last notice in the log
};

}  // namespace microinjection
