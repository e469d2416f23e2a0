#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/interval_histogram.h"
#include "cell_microinjection/CycleStatistics.h"
#include "nodes/bus/diagnostics.h"
#include "nodes/runtime/ports.h"

namespace microinjection {

/// The diagnostics of each cyclic node: rate, step time, the age of every input, and the node's own
/// tasks. Published each period of Diagnostics.
/// With them go statistics for other programs, /cycle_statistics (CycleStatistics).
class CycleDiagnostics {
 public:
  CycleDiagnostics(Bus& bus, double rate);

  void monitor(const InputPort& port) { inputs_.push_back(&port); }
  void monitor(const OutputPort& port) { outputs_.push_back(&port); }

  /// Adds a task of the node, which fills in level, message and values.
  void add(const std::string& name, const std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>& report);

  /// Adds the statistics of intervals (s).
  static void reportIntervals(const IntervalHistogram& intervals, diagnostic_updater::DiagnosticStatusWrapper& status);

  void beginStep();
  void endStep(const ros::Time& now);
  /// Publishes one task at once, for a result that must not wait for the next report.
  void publish(const std::string& name) { diagnostics_.publish(name); }

 private:
  void publishStatistics();
  void reportCycle(diagnostic_updater::DiagnosticStatusWrapper& status);
  std::string nameOf(const std::string& topic) const;
  void reportInputs(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportOutputs(diagnostic_updater::DiagnosticStatusWrapper& status);

  Bus& bus_;
  double rate_;  ///< Hz, nominal
  std::vector<const InputPort*> inputs_;
  std::vector<const OutputPort*> outputs_;
  Diagnostics diagnostics_;
  ros::Time now_;
  ros::Time reported_;
  ros::SteadyTime step_began_;
  unsigned steps_ = 0;           ///< since reported_
  double step_time_ = 0;         ///< s of wall time, sum since reported_
  double longest_step_ = 0;      ///< s of wall time, since reported_
  std::uint64_t all_steps_ = 0;  ///< since the start
  unsigned withheld_ = 0;        ///< messages up to the last report
  ros::Time began_;
  IntervalHistogram intervals_;  ///< of wall time between steps, since the start
  Publisher<cell_microinjection::CycleStatistics> statistics_;
};

}  // namespace microinjection
