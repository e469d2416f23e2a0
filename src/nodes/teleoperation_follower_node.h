#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <string>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/LinkPacket.h"
#include "nodes/runtime/cycle.h"
#include "operation/teleoperation/force_source.h"
#include "operation/teleoperation/link_follower.h"

namespace microinjection {

/// The rig's end of a network between haptic bridge and rig. It publishes the needle's target from
/// the hand's packets and sends the tip's force back. Without packets, needle, force or controller
/// it withdraws its target, so that the controller holds the needle, and reports this to the hand's
/// side.
///
/// In:  /link/rig/received (LinkPacket), /needle/measured_cp (PoseStamped), /cell/predicted_cf,
///      /force_sensor/measured_cf or both (WrenchStamped), /controller/injection_state
///      (InjectionStatus; that there is a controller)
/// Out: /link/rig/sent (LinkPacket), /teleop/servo_cp (PoseStamped, tip in `world`)
///
/// Parameters (private): those of ForceSourceConfig, link/... (LinkConfig; the bridge must have the
/// same) and
///   rate           Hz; default 1000, in [50, 5000]; that of the bridge
///   timeouts/...   s, past which an input is stale: needle, predicted, measured; default 0.05, in
///                  (0, inf); controller (0.25; 0: not checked, with another controller), in [0,
///                  inf)
class TeleoperationFollowerNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  TeleoperationFollowerNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    double rate = 1000;
    double needle_timeout = 0.05, predicted_timeout = 0.05, measured_timeout = 0.05;  // s
    double controller_timeout = 0.25;                                                 // s
    ForceSourceConfig force;
    LinkConfig link;
    static Parameters read(const ros::NodeHandle& private_node);
  };

  void step(const Cycle::Tick& tick);
  Input<geometry_msgs::WrenchStamped>* forceInput(bool used, const std::string& source, double timeout);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  LinkFollower model_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& needle_;
  Input<geometry_msgs::WrenchStamped>* predicted_;                     ///< null: not used
  Input<geometry_msgs::WrenchStamped>* measured_;                      ///< null: not used
  Input<cell_microinjection::InjectionStatus>* controller_ = nullptr;  ///< null: not checked
  Output<cell_microinjection::LinkPacket>& sent_;
  Output<geometry_msgs::PoseStamped>& target_;
};

}  // namespace microinjection
