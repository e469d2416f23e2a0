#pragma once

#include <ros/ros.h>

#include <memory>
#include <string>

#include "nodes/cycle.h"
#include "nodes/haptic/emulated_driver.h"
#include "nodes/round_trip_meter.h"
#include "teleoperation/hand_motion.h"
#include "teleoperation/virtual_hand.h"

namespace microinjection {

/// A haptic device that is not there, behind the topics of its driver, in a virtual hand: to try an adapter, and to
/// measure what all nodes add between the device's pose and the force that comes back to it (on /diagnostics). Live
/// only.
///
/// Topics: of the kind, see haptic/emulated_driver.h; In: /haptic/servo_cf, /needle/setpoint_trace,
///         /haptic/force_trace
///
/// Parameters (private): those of VirtualHandConfig and
///   kind           crtk, omni or geomagic; default crtk
///   motion         path of a hand motion (see teleoperation/hand_motion.h); required
///   start_delay    s, in which the hand rests before the motion; default 1, in [0, inf)
///   rate           Hz; default 1000, in [50, 5000]
class EmulatedHapticNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  EmulatedHapticNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    std::string kind = "crtk";
    std::string motion;
    double start_delay = 1;
    double rate = 1000;
    VirtualHandConfig hand;
    static Parameters read(const ros::NodeHandle& private_node);
  };

  void step(const Cycle::Tick& tick);
  void report(const std::string& name, const IntervalHistogram& trips);

  Parameters parameters_;
  HandMotion motion_;
  VirtualHand hand_;
  Cycle cycle_;
  RoundTripMeter meter_;
  std::unique_ptr<EmulatedDriver> driver_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  ///< N, held until the next comes, as drivers do
  double elapsed_ = 0;                               ///< s of steps; a stall of the machine pauses the hand
};

}  // namespace microinjection
