#pragma once

#include <sensor_msgs/FluidPressure.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <string>

#include "cell_microinjection/BoreState.h"
#include "cell_microinjection/InjectionPulse.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/StringStamped.h"
#include "hardware/injector/injector_model.h"
#include "hardware/injector/pulse_ids.h"
#include "nodes/pressure/pressure_device.h"
#include "nodes/runtime/command_log.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The injector: a pressure regulator behind the pipette, simulated or real, with the same topics.
/// Each pulse is executed once, or refused with the reason in the state. A repeated id is ignored,
/// an old message refused. A held pulse ends when its sender is stale, and any pulse when the ROS
/// master is lost.
///
/// In:  /injector/pulse (InjectionPulse; of a pulse that is held each repetition may change the pressure),
/// /injector/stop (StringStamped, the reason; ends the pulse
///      at any age), /injector/set_balance (sensor_msgs/FluidPressure: fluid_pressure, Pa, gauge,
///      although the message defines it as absolute; its variance is not used), with source simulated /cell/bore
///      (BoreState: a cell before the mouth lets less flow)
/// Out: /injector/state (InjectorState)
/// Services: ~reset (std_srvs/Trigger: clears fault, volume and what was drawn in), with source simulated ~clog
///      (std_srvs/SetBool)
///
/// Parameters: config/injector.yaml
class InjectorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit InjectorNode(Bus& bus);

 private:
  struct Parameters {
    double rate = 200;
    double command_timeout = 0.5;
    double pulse_timeout = 0.2;
    double clog_factor = 100;
    InjectorModelConfig model;
    PressureDevice device;
    static Parameters read(const Bus& bus);
  };

  void makeDevice();
  void onPulse(const cell_microinjection::InjectionPulse& message);
  void adjust(double pressure);
  void onStop(const cell_microinjection::StringStamped& message);
  void onBalance(const sensor_msgs::FluidPressure& message);
  std::string stampError(const std_msgs::Header& header) const;
  void endAbandonedPulse(const ros::Time& now);
  void step(const Cycle::Tick& tick);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  Cycle cycle_;
  std::unique_ptr<InjectorDevice> device_;
  InjectorModel* simulated_ = nullptr;                     ///< the device; null: a real one
  Input<cell_microinjection::BoreState>* bore_ = nullptr;  ///< of the simulated one
  PipetteFlow flow_;
  Output<cell_microinjection::InjectorState>& state_;
  PulseIds ids_;
  double held_pressure_ = 0;   ///< Pa, gauge, that its sender wants
  std::uint64_t held_ = 0;     ///< id of the held pulse under way; 0: none
  ros::Time last_repetition_;  ///< stamp of its last message
  bool master_lost_ = false;
  Subscription balance_;
  BusHandle reset_, clog_;
  unsigned repeated_ = 0;
  bool clogged_ = false;
  CommandLog log_;
};

}  // namespace microinjection
