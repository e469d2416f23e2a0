#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>
#include <sensor_msgs/TimeReference.h>

#include <memory>
#include <string>

#include "base/repetition.h"
#include "nodes/haptic/axes_service.h"
#include "nodes/haptic/force_receiver.h"
#include "nodes/haptic/peer_inputs.h"
#include "nodes/haptic/teleop_peer.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/loop_state.h"
#include "operation/link/link_config.h"
#include "operation/teleoperation/haptic_bridge.h"

namespace microinjection {

/// Couples a haptic device to the needle. It renders zero force and withdraws its target (stamp 0),
/// so that the controller holds the needle,
/// - when hand, needle or force is invalid, or repeats one value (Repetition),
/// - without a controller, since the needle then does not follow the hand,
/// - while the node that publishes the hand's position does not subscribe to its force
///   (haptic/force_receiver.h),
/// - while the device's axes are calibrated (haptic/axes_service.h),
/// - before it ends.
///
/// In:  /haptic/measured_cp (PoseStamped, the device's axes), /haptic/clutch and
///      /haptic/operator_present (Joy, buttons[0] is 1 while pressed or present; the latter counts
///      with require_operator)
/// Out: /haptic/servo_cf (WrenchStamped, N at the hand), /haptic/loop_state (LoopState),
///      /haptic/force_trace (TimeReference)
/// and those of LocalPeer or, with link/scheme wave, of RemotePeer.
/// Service: ~calibrate_axes (CalibrateAxes)
///
/// Parameters: config/haptic_bridge.yaml
class HapticBridgeNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit HapticBridgeNode(Bus& bus);

 private:
  struct Timeouts {  // s
    double hand = 0.05;
    double hand_unchanged = 2;  ///< of a pose, see Repetition; 0: for ever
    double clutch = 0;
    double operator_present = 0.2;
    PeerTimeouts rig;
    static Timeouts read(ConfigReader reader);
  };
  struct Parameters {
    double rate = 1000;
    bool force_feedback = true;
    bool quiet_sensor = false;
    std::string axes_file;  ///< that a calibration of the axes writes; empty: of the user's data
    Timeouts timeouts;
    HapticBridgeConfig model;
    LinkConfig link;
    static Parameters read(const Bus& bus);
  };

  void step(const Cycle::Tick& tick);
  double longestUnchanged() const;
  void watch(const geometry_msgs::PoseStamped& hand, const ros::Time& now);
  void takeAxes();
  bool clutchPressed(const ros::Time& now) const;
  bool operatorPresent(const ros::Time& now) const;
  void publishZeroForce();
  std::string holdReason() const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  HapticBridge model_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& hand_;
  Input<sensor_msgs::Joy>& clutch_;
  Input<sensor_msgs::Joy>* operator_present_ = nullptr;  ///< null: not required
  Output<geometry_msgs::WrenchStamped>& hand_force_;
  Output<sensor_msgs::TimeReference>& trace_;
  std::unique_ptr<TeleopPeer> rig_;
  LoopStatePublisher loop_state_;
  ForceReceiver receiver_;
  Repetition<Eigen::Vector3d> hand_poses_;  ///< m, exposed to s
  std::optional<Eigen::Vector3d> led_to_;   ///< m, the needle's target when the hand was watched last
  ros::Time watched_;                       ///< the last of them
  geometry_msgs::PoseStamped last_hand_;    ///< valid, of any device
  bool hand_leaps_ = false;                 ///< since the last step
  AxesService axes_;
  std::string hand_frame_;       ///< of the last hand
  HapticBridge::Output output_;  ///< of the last step, for the diagnostics
};

}  // namespace microinjection
