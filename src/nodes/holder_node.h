#pragma once

#include <sensor_msgs/FluidPressure.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <string>
#include <vector>

#include "base/operating_state.h"
#include "cell_microinjection/HolderState.h"
#include "cell_microinjection/HoldingSeal.h"
#include "cell_microinjection/OperatingState.h"
#include "cell_microinjection/StringStamped.h"
#include "hardware/injector/injector_model.h"
#include "hardware/injector/pressure_line.h"
#include "hardware/injector/serial_injector.h"
#include "hardware/manipulator/command_authority.h"
#include "nodes/pressure/pressure_device.h"
#include "nodes/runtime/command_log.h"
#include "nodes/runtime/command_source.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The holder: the pressure line of the holding pipette, simulated, or with any device of config/injectors whose
/// pressure can be set.
///
/// One rule decides all cases: the pressure is kept. To let go of a cell while a needle is in it tears the cell, so
/// nothing but a new set-point changes the pressure: not `disable`, not a fault, not a commander that falls silent, not
/// the end or the restart of this node. For that reason a device has no stop guard here, and is told no pressure at the
/// start. An injector does the contrary in each case, which is why the two are two nodes.
///
/// Set-points of one node at a time are followed. A second one within commander_timeout of the first is a fault until
/// `enable`, since neither knows what the other wants.
///
/// In:  /holder/set_pressure (sensor_msgs/FluidPressure: fluid_pressure, Pa, gauge, of the source, although the message
///      defines it as absolute; its variance is not used), refused without a stamp, when old, and unless ENABLED
///      /holder/state_command (StringStamped: enable, disable, pause, resume of base/operating_state.h)
///      /cell/seal (HoldingSeal): what closes the mouth, of a simulated cell; until it comes, parameter `sealed`
/// Out: /holder/state (HolderState), stamp 0 while the pressure is not known
///      /holder/operating_state (OperatingState; on change and after each state_command), FAULT while the device has
///      one; is_homed is true, is_busy false
/// Services: ~reset (std_srvs/Trigger: clears the device's fault and the volume)
///
/// Parameters: config/holder.yaml
class HolderNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit HolderNode(Bus& bus);

 private:
  struct Parameters {
    double rate = 200;
    double command_timeout = 0.5;
    double commander_timeout = 1;
    bool auto_enable = true;
    bool sealed = true;
    InjectorModelConfig model;
    PressureLineConfig line;
    PressureDevice device;
    static Parameters read(const Bus& bus);
  };

  void subscribe();
  void onPressure(const sensor_msgs::FluidPressure& message, const std::string& sender);
  std::string set(const sensor_msgs::FluidPressure& message, const std::string& sender);
  void onState(const cell_microinjection::StringStamped& message, const CommandSource& source);
  std::string executeState(const cell_microinjection::StringStamped& message, const CommandSource& source);
  void onSeal(const cell_microinjection::HoldingSeal& message);

  OperatingState state() const;
  std::string fault() const;  ///< of the device, or of two commanders; empty: none
  bool known() const { return !device_ || device_->pressureKnown(); }
  void watchCommander(const ros::Time& now);
  void step(const Cycle::Tick& tick);
  void publish(const ros::Time& now);
  void publishOperatingState(const ros::Time& now, bool reply);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  Cycle cycle_;
  PressureLine line_;
  std::unique_ptr<SerialInjector> device_;  ///< null: simulated
  Output<cell_microinjection::HolderState>& state_;
  Publisher<cell_microinjection::OperatingState> operating_state_;
  std::string published_state_;
  RepeatedCommands repeated_;
  std::vector<Subscription> subscriptions_;
  BusHandle reset_;
  OperatingState commanded_ = OperatingState::kDisabled;
  CommandAuthority authority_{"the holder"};
  double target_ = 0;       ///< Pa, gauge, that was last accepted
  std::string commander_;   ///< node of the last accepted set-point
  ros::Time commanded_at_;  ///< when it came; zero: none yet
  bool streams_ = false;    ///< it has sent at least two, commander_timeout apart at most
  std::string kept_;        ///< as in HolderState
  CommandLog log_;
};

}  // namespace microinjection
