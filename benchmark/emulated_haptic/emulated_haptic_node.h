#pragma once

#include <geometry_msgs/WrenchStamped.h>

#include <memory>
#include <string>

#include "benchmark/emulated_haptic/emulated_driver.h"
#include "benchmark/emulated_haptic/round_trip_meter.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/runtime/cycle.h"
#include "operation/teleoperation/hand_motion.h"
#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {

/// Emulates a haptic device, its driver's topics and the operator's hand. It tests an adapter and
/// measures the delay of all nodes from the device's pose to the resulting force (on /diagnostics).
///
/// The hand holds the dead-man switch down from half the start_delay on, except in the phase
/// `away`. In the phase `inject` it presses the inject button, if the device has one.
///
/// Topics of the kind, see emulated_driver.h, and
/// In:  /haptic/servo_cf, /needle/setpoint_trace, /haptic/force_trace
/// Out: /emulated_haptic/measured_cf (WrenchStamped, N on the hand, in the view's axes),
///      /virtual_hand/phase (StringStamped, latched, on change: the motion's phases, then done)
///
/// Parameters: see kHelp
class EmulatedHapticNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit EmulatedHapticNode(Bus& bus);

 private:
  struct Parameters {
    std::string kind = "crtk";
    std::string motion;
    double start_delay = 1;
    double rate = 1000;
    VirtualHandConfig hand;
    static Parameters read(const Bus& bus);
  };

  void step(const Cycle::Tick& tick);
  void publishPhase(const ros::Time& now, const std::string& phase);
  void report(const std::string& name, const IntervalHistogram& trips);

  Parameters parameters_;
  HandMotion motion_;
  VirtualHand hand_;
  Cycle cycle_;
  RoundTripMeter meter_;
  std::unique_ptr<EmulatedDriver> driver_;
  Output<geometry_msgs::WrenchStamped>& force_;
  Output<cell_microinjection::StringStamped>& phase_;
  EmulatedHand at_;
  double elapsed_ = 0;  ///< s of steps; a stall of the machine pauses the hand
  std::string phase_published_;
};

}  // namespace microinjection
