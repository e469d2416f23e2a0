#pragma once

#include <sensor_msgs/FluidPressure.h>

#include <string>

#include "cell_microinjection/HolderState.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/stamps.h"
#include "virtual_session.h"

namespace microinjection {

/// The test asks the holder for pressures, and hears its state.
class HolderWorld {
 public:
  explicit HolderWorld(VirtualSession& session)
      : session_(session),
        states_(session.world().hear<cell_microinjection::HolderState>("holder/state")),
        operating_(session.world().hear<cell_microinjection::OperatingState>("holder/operating_state")) {}

  /// Pa, gauge, by the test's node or another one. `age`: s, of its stamp.
  void set(double pressure, double age = 0) { setBy(session_.world(), pressure, age); }
  void setBy(TestNode& node, double pressure, double age = 0) {
    sensor_msgs::FluidPressure message;
    message.fluid_pressure = pressure;
    message.header.stamp = session_.now() - durationOf(age);
    node.say("holder/set_pressure", message);
  }
  void command(const std::string& word) { session_.world().command("holder/state_command", word); }

  const Probe<cell_microinjection::HolderState>& states() const { return states_; }
  /// The newest ones; there must be some.
  const cell_microinjection::HolderState& state() const { return *states_.newest(); }
  const cell_microinjection::OperatingState& operating() const { return *operating_.newest(); }
  bool isKnown() const { return states_.newest() && !state().header.stamp.isZero(); }

 private:
  VirtualSession& session_;
  Probe<cell_microinjection::HolderState>& states_;
  Probe<cell_microinjection::OperatingState>& operating_;
};

}  // namespace microinjection
