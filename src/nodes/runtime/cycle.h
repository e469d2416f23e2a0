#pragma once

#include <functional>
#include <memory>
#include <string>

#include "nodes/bus/bus.h"
#include "nodes/runtime/cycle_diagnostics.h"
#include "nodes/runtime/cycle_ports.h"

namespace microinjection {

/// The steps of a node, and the inputs and outputs that they read and write. The bus decides when the
/// node steps. All callbacks and steps run in the thread of the bus. While the bus is lost, no input is
/// fresh.
class Cycle {
 public:
  struct Tick {
    ros::Time now;
    double dt = 0;  ///< s since the last step, at first the nominal period; at most ten periods, so that
                    ///< nothing jumps after a stall of the machine
  };

  /// `rate` in Hz. `bus` outlives the cycle.
  Cycle(Bus& bus, double rate);
  Cycle(const Cycle&) = delete;

  /// References are valid for the life of the cycle. `timeout`: age (s) past which the input is
  /// stale.
  template <typename Message>
  Input<Message>& input(const std::string& topic, InputPhase phase, double timeout);
  template <typename Message>
  Output<Message>& output(const std::string& topic, bool latch = false);

  Bus& bus() { return bus_; }
  const Bus& bus() const { return bus_; }
  CycleDiagnostics& diagnostics() { return diagnostics_; }
  bool masterLost() const { return master_lost_; }  ///< in this step
  double period() const { return period_; }         ///< s
  /// Earliest arrival of a message that is received now; see StallMonitor.
  ros::Time earliestArrival() const { return ports_.stalls.earliest(); }

  /// Steps from now on.
  void onStep(std::function<void(const Tick&)> step);

 private:
  template <typename Message>
  void subscribe(Input<Message>& port);
  void checkMaster();
  void step(const ros::Time& now);

  Bus& bus_;
  double period_;
  CyclePorts ports_;
  CycleDiagnostics diagnostics_;
  std::function<void(const Tick&)> step_;
  ros::Time last_step_;
  bool master_lost_ = false;
};

/// Length of the message queues: five seconds without the processor, since the recorder must receive
/// each message.
constexpr int kBacklog = 5000;

template <typename Message>
Input<Message>& Cycle::input(const std::string& topic, InputPhase phase, double timeout) {
  auto owned = std::make_unique<Input<Message>>(topic, phase, timeout, bus_.refusals());
  Input<Message>& port = *owned;
  ports_.inputs.push_back(std::move(owned));
  diagnostics_.monitor(port);
  subscribe(port);
  return port;
}

template <typename Message>
void Cycle::subscribe(Input<Message>& port) {
  const auto receive = [this, &port](const Delivery<Message>& delivery) {
    const ros::Time received = delivery.raw.received, earliest = ports_.stalls.earliest();
    const Arrival arrival{received, earliest.isZero() ? received : std::min(received, earliest), delivery.raw.sender,
                          delivery.raw.latched};
    // The handlers of an input are the node's own code and may throw.
    runGuarded(port.refusals, port.topic, [&] { port.receive(delivery.message, arrival); });
  };
  const Serving serving = port.phase == InputPhase::kDrives  ? Serving::kDrives
                          : port.phase == InputPhase::kWakes ? Serving::kWakes
                                                             : Serving::kSampled;
  port.subscription = bus_.subscribe<Message>(port.topic, kBacklog, receive, serving);
}

template <typename Message>
Output<Message>& Cycle::output(const std::string& topic, bool latch) {
  auto owned = std::make_unique<Output<Message>>(topic);
  Output<Message>& port = *owned;
  ports_.outputs.push_back(std::move(owned));
  diagnostics_.monitor(port);
  port.publisher = bus_.advertise<Message>(topic, 10, latch);
  return port;
}

}  // namespace microinjection
