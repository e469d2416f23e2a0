#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"
#include "nodes/runtime/cycle_diagnostics.h"
#include "nodes/runtime/ports.h"
#include "nodes/runtime/stall_monitor.h"

namespace microinjection {

/// The topics of a cycle.
struct CyclePorts {
  std::vector<std::unique_ptr<InputPort>> inputs;
  std::vector<std::unique_ptr<OutputPort>> outputs;
  StallMonitor stalls;
};

/// The steps of a node that computes at a rate, as all nodes from the hand to the cell and back do, and the inputs
/// and outputs that the steps read and write.
///
///     messages --> Input: stamp, sender, age --+
///                                              v
///     Bus::setStep --> clock, master --> onStep(Tick) --> Output: finite numbers only --> topics
///                                              |
///                                              '--> CycleDiagnostics: rate, step time, age of each input
///
/// A node of roscpp usually computes in its callbacks. Then the order in which messages happen to arrive decides
/// which values a computation sees, every node judges by itself what is too old, and the time between two
/// computations is whatever the network makes it. In a Cycle callbacks only store; the step reads all inputs at one
/// time, each with the same rules of what is fresh (InputPort::fresh), and knows how long ago it was called before.
/// When it is called is the bus' business: by the message that it waits for on a live rig, in the order of the data
/// flow on virtual time.
///
/// All callbacks and steps run in the thread of the bus, so that a node needs no lock. A step must not wait, or write
/// to a file or a terminal. While the master is lost no input is fresh, because nobody new could send `disable`. When
/// the session's clock is set back, all that was received is invalid; while it stands, or has not started, there is
/// no step.
class Cycle {
 public:
  struct Tick {
    ros::Time now;  ///< of the session; the same for everything in this step
    double dt = 0;  ///< s since the last step, at first the nominal period; at most ten periods, so that
                    ///< nothing jumps after a stall of the machine
  };

  /// `rate`: nominal one (Hz, > 0), of a node that no message drives. `bus` outlives the cycle.
  Cycle(Bus& bus, double rate);
  Cycle(const Cycle&) = delete;

  /// Subscribes a topic, whose messages have a header. References are valid for the life of the cycle. `phase`:
  /// whether a message starts a step. `timeout`: age (s of the session's time) past which the input is stale;
  /// INFINITY for a topic that tells changes only.
  template <typename Message>
  Input<Message>& input(const std::string& topic, InputPhase phase, double timeout);
  /// Advertises a topic. `latch`: a later subscriber first receives the last message.
  template <typename Message>
  Output<Message>& output(const std::string& topic, bool latch = false);

  Bus& bus() { return bus_; }
  const Bus& bus() const { return bus_; }
  CycleDiagnostics& diagnostics() { return diagnostics_; }
  bool masterLost() const { return master_lost_; }  ///< in this step
  double period() const { return period_; }         ///< s
  /// The earliest time at which a message that is received now may have arrived: a node that was frozen finds old
  /// ones. Zero before the first step; see StallMonitor.
  ros::Time earliestArrival() const { return ports_.stalls.earliest(); }

  /// Has `step` called from now on, once the bus runs. An exception of it ends the node.
  void onStep(std::function<void(const Tick&)> step);

 private:
  template <typename Message>
  void subscribe(Input<Message>& port);
  void checkMaster();  ///< marks all inputs as disconnected while the master is lost
  void step(const ros::Time& now);

  Bus& bus_;
  double period_;  ///< s
  CyclePorts ports_;
  CycleDiagnostics diagnostics_;
  std::function<void(const Tick&)> step_;
  ros::Time last_step_;  ///< zero: none yet
  bool master_lost_ = false;
};

/// Messages that may wait for a node: five seconds at 1 kHz without the processor. The recorder must receive each
/// message, and runs at ordinary priority where the system allows no other; most other nodes need the newest one
/// only.
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
