#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "operation/link/link_config.h"
#include "operation/link/link_emulator.h"
#include "operation/teleoperation/haptic_bridge.h"
#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {

/// A hand, a haptic device, the bridge, a network, a needle and an elastic thing with the needle's
/// motion along one axis.
struct TeleoperationLoop {
  enum class Controller { kOff, kObserver, kWave };
  static constexpr double kPressedForce = 1.2;  ///< N that the hand means to press with

  VirtualHandConfig hand;
  double device_damping = 0.2;      ///< N s/m, of the device itself
  double device_resolution = 2e-5;  ///< m, of the device's encoders
  double stiffness = 60;            ///< N/m at the hand, of what is touched; nothing damps it
  LinkConditions link;              ///< either way
  /// N on the needle at the hand's scale, of what it touches, by its place (m, at that scale) in each period. One for
  /// each run; none: a spring of that stiffness.
  using Touched = std::function<double(double)>;
  std::function<Touched()> makeTouched;
  bool chatter = false;  ///< the force drops to zero and returns, again and again, as a membrane that gives way
  Controller controller = Controller::kObserver;
  HapticBridgeConfig bridge;
  LinkConfig wave;

  struct Sample {
    double time;             ///< s
    double hand;             ///< m
    double needle;           ///< m, at the hand's scale
    double force;            ///< N, on the hand
    double touched;          ///< N, on the needle, at the hand's scale
    double observed_energy;  ///< J, by the bridge
  };
  struct Result {
    double observed_energy_min = 0;  ///< J, by the bridge, with the device's encoders
    double true_energy_min = 0;      ///< J, of force and motion themselves
    double margin_min = 0;           ///< J, of the waves' two directions; 0 without waves
    double peak_force = 0;           ///< N, on the hand
    double peak_force_rate = 0;      ///< N/s
    double overshoot = 0;            ///< m, of the needle below the deepest that the hand was, at the hand's scale
    double drift = 0;                ///< m of the needle, from where the bridge wants it, back in free motion
    double late_amplitude = 0;       ///< m, rms of the hand about a line in the last second of the worse hold
    double late_over_early = 0;      ///< 1, over the rms in the second before
    double contact_force = 0;        ///< N, mean over the last second of the first hold, on the hand
    double needle_force = 0;         ///< N, of what is touched, in the same time, at the hand's scale
    double touched_energy_min = 0;   ///< J, of what is touched, got from the needle, at the hand's scale
    std::vector<Sample> samples;
  };

  /// In virtual time: in by a second, held, half out, held, out.
  Result run() const;
};

}  // namespace microinjection
