#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell_microinjection/CellState.h"
#include "cell_microinjection/CycleStatistics.h"
#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/LoopState.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/recording/session_files.h"
#include "nodes/runtime/bare_timer_loop.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/latency_meter.h"
#include "operation/record/session_table.h"
#include "operation/record/training_log.h"

namespace microinjection {

/// Records a session in force_depth.csv (one row per `row_period`), summary.yaml (rates of every
/// node and, live, the latency from hand to force beside a bare timer loop) and session.bag. All
/// are complete at the end of the session. Until then rows and messages are in
/// force_depth.csv.active and session.bag.active, which survive a kill. A file that cannot be
/// written is an ERROR on /diagnostics ("files") and does not end the session. When a file is
/// incomplete at the end, the exit status is 1.
///
/// In:  /needle/measured_cp, /cell/predicted_cf, /force_sensor/measured_cf, /cell/state,
///      /controller/injection_state, with an injector /injector/state, with a
///      holder /holder/state, with a hand
///      /haptic/measured_cp, /haptic/servo_cf, /haptic/clutch, /virtual_hand/phase;
///      /needle/setpoint_trace, /haptic/force_trace; /diagnostics, /tf, /tf_static,
///      /controller/operating_state
///
/// Live it reads its messages a hundred times a second and writes rows two seconds later, by the
/// stamps of the messages (see SessionTable). It rarely needs the processor, and a delay does not
/// change the rows.
///
/// Parameters: see kHelp
class SessionRecorderNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit SessionRecorderNode(Bus& bus);

 private:
  struct Parameters {
    std::string output_dir;
    double row_period = 0.005;
    bool hand = true;
    bool injector = true;
    bool holder = false;
    bool bag = true;
    bool end_when_done = false;
    std::optional<TrainingConfig> training;
    static Parameters read(const Bus& bus);
  };
  void measureMachine();
  void fillTable();
  void recordBag(SessionBag& bag);
  void step(const Cycle::Tick& tick);
  void withdrawInvalid();
  void finish();
  std::string summary() const;
  void score(std::vector<std::string>& errors) const;

  Parameters parameters_;
  Cycle cycle_;
  SessionFiles files_;
  SessionTable table_;
  Input<geometry_msgs::WrenchStamped>& predicted_;
  Input<geometry_msgs::PoseStamped>& needle_;
  Input<geometry_msgs::WrenchStamped>& measured_;
  Input<cell_microinjection::CellState>& cell_;
  Input<cell_microinjection::InjectionStatus>& injection_;
  Input<cell_microinjection::InjectorState>* injector_ = nullptr;  ///< null without an injector
  Input<geometry_msgs::PoseStamped>* hand_ = nullptr;              ///< null without a hand
  Input<sensor_msgs::Joy>* clutch_ = nullptr;                      ///< null without a hand
  Input<geometry_msgs::WrenchStamped>* hand_force_ = nullptr;      ///< null without a hand
  Input<cell_microinjection::StringStamped>* phase_ = nullptr;     ///< null without a hand
  Subscription statistics_;
  std::string began_;                          ///< local date and time, ISO 8601
  std::unique_ptr<TrainingLog> training_;      ///< null without training
  std::unique_ptr<LatencyMeter> latency_;      ///< null where wall time has no meaning
  std::unique_ptr<BareTimerLoop> timer_loop_;  ///< null where wall time has no meaning

  Eigen::Matrix3d tip_orientation_ = Eigen::Matrix3d::Identity();      ///< newest, in world
  std::vector<std::string> layers_;                                    ///< of the cell, outermost first
  std::map<std::string, cell_microinjection::CycleStatistics> nodes_;  ///< by name
};

}  // namespace microinjection
