#pragma once

#include <ros/ros.h>

#include <functional>
#include <memory>
#include <string>

#include "nodes/runtime/cycle_diagnostics.h"
#include "nodes/runtime/cycle_ports.h"
#include "nodes/runtime/live_pacing.h"
#include "nodes/runtime/lockstep_pacing.h"
#include "nodes/runtime/master_monitor.h"

namespace microinjection {

/// Decides when a node steps, and with which inputs. All callbacks and steps run in the thread that
/// calls run(). LivePacing decides, or LockstepPacing if the parameter /lockstep/participants
/// contains this node.
///
/// While the master is lost (nodes/runtime/master_monitor.h) no input is fresh. When the master is
/// lost for long (MasterMonitor::masterLostForLong) and the node is at rest, run() ends.
class Cycle {
 public:
  struct Tick {
    ros::Time now;
    double dt = 0;  ///< s since the last step, at first the nominal period; at most ten periods, so that
                    ///< nothing jumps after a stall of the machine
  };

  /// `rate` in Hz.
  Cycle(const ros::NodeHandle& node, double rate);

  /// References are valid for the life of the cycle. `timeout`: age (s) past which the input is
  /// stale.
  template <typename Message>
  Input<Message>& input(const std::string& topic, InputPhase phase, double timeout);
  template <typename Message>
  Output<Message>& output(const std::string& topic, bool latch = false);

  /// A node handle for topics outside of the lock step: its callbacks run in this thread right
  /// before a step.
  ros::NodeHandle& node() { return ports_.sampled_node; }
  CycleDiagnostics& diagnostics() { return diagnostics_; }
  /// In lock step: nothing may depend on wall time or on the order of connections.
  bool deterministic() const { return lockstep_ != nullptr; }
  bool masterLost() const { return master_lost_; }  ///< in this step
  double period() const { return period_; }         ///< s
  /// Earliest arrival of a message that is received now; see StallMonitor.
  ros::Time earliestArrival() const { return ports_.stalls.earliest(); }

  /// Steps until ROS shuts down or stop() is called.
  void run(const std::function<void(const Tick&)>& step);
  void stop() { stopped_ = true; }
  /// Whether something moves or flows that this node must monitor even when the master is lost for
  /// long; default false.
  void setBusy(bool busy) { busy_ = busy; }

 private:
  bool shouldContinue();
  void checkMaster();
  void step(const ros::Time& now);

  double period_;
  bool stopped_ = false;
  bool busy_ = false;
  CyclePorts ports_;
  LivePacing live_;
  std::unique_ptr<LockstepPacing> lockstep_;  // null: live
  CycleDiagnostics diagnostics_;
  std::function<void(const Tick&)> step_;
  ros::Time last_step_;
  bool master_lost_ = false;
  MasterMonitor master_;
};

template <typename Message>
Input<Message>& Cycle::input(const std::string& topic, InputPhase phase, double timeout) {
  if (phase == InputPhase::kTrigger) phase = deterministic() ? InputPhase::kPreviousTick : InputPhase::kThisTick;
  auto owned = std::make_unique<Input<Message>>(topic, phase, timeout);
  Input<Message>& port = *owned;
  ports_.inputs.push_back(std::move(owned));
  diagnostics_.monitor(port);
  lockstep_ ? lockstep_->subscribe(port) : live_.subscribe(port);
  return port;
}

template <typename Message>
Output<Message>& Cycle::output(const std::string& topic, bool latch) {
  auto owned = std::make_unique<Output<Message>>(topic);
  Output<Message>& port = *owned;
  ports_.outputs.push_back(std::move(owned));
  diagnostics_.monitor(port);
  lockstep_ ? lockstep_->advertise(port) : live_.advertise(port, latch);
  return port;
}

}  // namespace microinjection
