#pragma once

#include <actionlib_msgs/GoalID.h>
#include <cell_microinjection/CellEstimate.h>
#include <cell_microinjection/CellState.h>
#include <cell_microinjection/InjectionStatus.h>
#include <cell_microinjection/InjectorState.h>
#include <cell_microinjection/LoopState.h>
#include <cell_microinjection/OperatingState.h>
#include <cell_microinjection/Readiness.h>
#include <cell_microinjection/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/bus/bus.h"
#include "operation/console/cell_lines.h"
#include "operation/console/device_lamps.h"
#include "operation/console/force_history.h"
#include "operation/console/session_view.h"
#include "operation/record/session_table.h"

namespace microinjection {

/// What the console hears of a session, and its one publisher.
///
/// In:  /controller/operating_state, /controller/injection_state, /controller/loop_state,
///      /cell/state, /cell/estimate, /force_sensor/measured_cf, /injector/state, /session/readiness, /diagnostics
/// Out: /controller/state_command (StringStamped); with a stop, the cancels of the actions that move
///      the needle through vision (kStoppedActions)
///
/// All queues have length 1 and nothing latches: a console that hangs neither fills a queue of the
/// loop nor leaves a command behind.
class SessionLink {
 public:
  using Pose = SessionTable::Pose;

  /// `pipette`: gives tip and axis in `world`, or nothing where tf does not have them.
  SessionLink(Bus& bus, std::function<std::optional<Pose>()> pipette);

  /// Handles the messages that came. Never waits for one. Returns whether the history has grown.
  bool poll();
  /// Sends a command of the operator with the present stamp.
  void send(const std::string& command);
  /// The same, and cancels what would move needle or focus on: these nodes do not hear the
  /// controller's commands, and a calibration runs while the controller is DISABLED.
  void stop(const std::string& command);

  SessionView session() const;
  Lamp lamp(Device device) const;
  std::optional<CellEstimateView> estimate() const;
  std::optional<InjectorView> injector() const;                       ///< its newest state; empty: none for too long
  bool injectorHeard() const { return injector_.value.has_value(); }  ///< the session has one
  const ForceHistory& history() const { return history_; }
  /// `handler` receives the session's values at each state of the cell.
  void onRow(std::function<void(const SessionTable::Row&)> handler) { row_handler_ = std::move(handler); }
  /// The model of the served cell with its expected error, or the last change of its parameters;
  /// empty: not known.
  std::string servedCell() const;

 private:
  template <typename Message>
  void subscribe(const std::string& topic, void (SessionLink::*receive)(const Message&));
  void onOperating(const cell_microinjection::OperatingState& message);
  void onInjection(const cell_microinjection::InjectionStatus& message);
  void onLoop(const cell_microinjection::LoopState& message);
  void onCell(const cell_microinjection::CellState& message);
  void onEstimate(const cell_microinjection::CellEstimate& message);
  void onMeasured(const geometry_msgs::WrenchStamped& message);
  void onInjector(const cell_microinjection::InjectorState& message);
  void onReadiness(const cell_microinjection::Readiness& message);
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  void readSettings();

  /// A value and the time (s) at which it came.
  template <typename Value>
  struct Received {
    Value value;
    double at = 0;
  };

  SessionTable::Row rowOf(const cell_microinjection::CellState& message, const std::optional<Pose>& pipette) const;

  Bus& bus_;
  std::function<std::optional<Pose>()> pipette_;
  std::function<void(const SessionTable::Row&)> row_handler_;
  Publisher<cell_microinjection::StringStamped> commands_;
  std::vector<Publisher<actionlib_msgs::GoalID>> cancels_;
  SessionView session_;
  std::optional<double> heard_at_;  ///< s, of the controller's last message
  Received<std::optional<SessionTable::Measured>> measured_;
  int punctures_ = 0;  ///< detected by the controller
  Received<std::optional<CellEstimateView>> estimate_;
  Received<std::optional<InjectorView>> injector_;
  Received<std::optional<HindranceView>> hindrance_;
  DeviceLamps lamps_;
  ForceHistory history_;
  bool grown_ = false;
  std::string served_, changed_;  ///< of the cell simulator's reports
  std::vector<Subscription> subscriptions_;
};

}  // namespace microinjection
