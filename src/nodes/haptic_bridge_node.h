#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <sensor_msgs/TimeReference.h>

#include <memory>
#include <string>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/LinkPacket.h"
#include "nodes/haptic/force_receiver.h"
#include "nodes/runtime/cycle.h"
#include "operation/teleoperation/haptic_bridge.h"
#include "operation/teleoperation/link_leader.h"

namespace microinjection {

/// Couples a haptic device to the needle. It renders zero force and withdraws its target (stamp 0),
/// so that the controller holds the needle,
/// - when hand, needle or force is invalid,
/// - without a controller, since the needle then does not follow the hand,
/// - while the node that publishes the hand's position does not subscribe to its force
///   (haptic/force_receiver.h),
/// - before it ends.
///
/// In:  /haptic/measured_cp (PoseStamped, the device's axes), /haptic/clutch and
///      /haptic/operator_present (Joy, buttons[0] is 1 while pressed or present; the latter counts
///      with require_operator), /needle/measured_cp (PoseStamped), /cell/predicted_cf,
///      /force_sensor/measured_cf or both (WrenchStamped), /controller/injection_state
///      (InjectionStatus, to detect the controller)
/// Out: /haptic/servo_cf (WrenchStamped, N at the hand), /teleop/servo_cp (PoseStamped, tip in
///      `world`), /haptic/force_trace (TimeReference)
///
/// With link/scheme wave the rig is behind a network. Packets from and to teleoperation_follower
/// then carry needle, force and target: /link/hand/received and /link/hand/sent (LinkPacket).
///
/// Parameters (private): those of HapticBridgeConfig, link/... (LinkConfig) and
///   rate           Hz; default 1000, in [50, 5000]
///   force_feedback whether the device renders a force, so that its driver must subscribe to it;
///                  default true
///   timeouts/...   s, past which an input is stale, each its own: hand, needle, predicted,
///                  measured (default 0.05), in (0, inf); operator_present (0.2; 0: valid until the
///                  hand is stale), clutch (0: always valid, for devices that publish changes only)
///                  and controller (0.25; 0: not checked, with another controller), in [0, inf)
class HapticBridgeNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  HapticBridgeNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Timeouts {  // s
    double hand = 0.05;
    double clutch = 0;
    double operator_present = 0.2;
    double needle = 0.05;
    double predicted = 0.05;
    double measured = 0.05;
    double controller = 0.25;
    static Timeouts read(ConfigReader reader);
  };
  struct Parameters {
    double rate = 1000;
    bool force_feedback = true;
    Timeouts timeouts;
    HapticBridgeConfig model;
    LinkConfig link;
    static Parameters read(const ros::NodeHandle& private_node);
  };

  void step(const Cycle::Tick& tick);
  void connectRig();
  void connectLink();
  void readRig(HapticBridge::Input& input, const Cycle::Tick& tick);
  void sendToRig(const Cycle::Tick& tick);
  void trace(const Cycle::Tick& tick);
  Input<geometry_msgs::WrenchStamped>* forceInput(bool used, const std::string& source, double timeout);
  bool clutchPressed(const ros::Time& now) const;
  bool operatorPresent(const ros::Time& now) const;
  bool controllerIsAlive(const ros::Time& now) const;
  void publishZeroForce();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  HapticBridge model_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& hand_;
  Input<sensor_msgs::Joy>& clutch_;
  Input<sensor_msgs::Joy>* operator_present_ = nullptr;                ///< null: not required
  Input<geometry_msgs::PoseStamped>* needle_ = nullptr;                ///< null: behind a network
  Input<geometry_msgs::WrenchStamped>* predicted_ = nullptr;           ///< null: not used
  Input<geometry_msgs::WrenchStamped>* measured_ = nullptr;            ///< null: not used
  Input<cell_microinjection::InjectionStatus>* controller_ = nullptr;  ///< null: not checked, or behind a network
  Output<geometry_msgs::WrenchStamped>& hand_force_;
  Output<geometry_msgs::PoseStamped>* target_ = nullptr;  ///< null: behind a network
  std::unique_ptr<LinkLeader> link_;                      ///< null: no network
  Output<cell_microinjection::LinkPacket>* link_sent_ = nullptr;
  Output<sensor_msgs::TimeReference>& trace_;
  ForceReceiver receiver_;
  std::string hand_frame_;           ///< of the last hand
  bool without_controller_ = false;  ///< in the last step
  HapticBridge::Output output_;      ///< of the last step, for the diagnostics
};

}  // namespace microinjection
