#pragma once

#include <sensor_msgs/FluidPressure.h>

#include <string>

#include "cell_microinjection/InjectionPulse.h"
#include "cell_microinjection/InjectorState.h"
#include "nodes/runtime/stamps.h"
#include "virtual_session.h"

namespace microinjection {

/// The test asks the injector for pulses and balance pressures, and hears its state.
class InjectorWorld {
 public:
  static constexpr double kPressure = 20e3;  // Pa, gauge

  explicit InjectorWorld(VirtualSession& session)
      : session_(session), states_(session.world().hear<cell_microinjection::InjectorState>("injector/state")) {}

  /// Pa, s. `age`: s, of its stamp.
  void send(std::uint64_t id, double pressure = kPressure, double duration = 0.05, double age = 0, bool held = false) {
    cell_microinjection::InjectionPulse message;
    message.header.stamp = session_.now() - durationOf(age);
    message.id = id;
    message.pressure = pressure;
    message.duration = duration;
    message.held = held;
    session_.world().say("injector/pulse", message);
  }
  void stop(double age = 0) {
    cell_microinjection::StringStamped message;
    message.header.stamp = session_.now() - durationOf(age);
    message.string = "the test says so";
    session_.world().say("injector/stop", message);
  }
  /// Pa, gauge.
  void setBalance(double pressure) {
    sensor_msgs::FluidPressure message;
    message.fluid_pressure = pressure;
    session_.world().sayNow("injector/set_balance", message);
  }

  const Probe<cell_microinjection::InjectorState>& states() const { return states_; }
  /// The newest one; there must be one.
  const cell_microinjection::InjectorState& state() const { return *states_.newest(); }

 private:
  VirtualSession& session_;
  Probe<cell_microinjection::InjectorState>& states_;
};

}  // namespace microinjection
