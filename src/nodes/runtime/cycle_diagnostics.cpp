#include "nodes/runtime/cycle_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microinjection {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

CycleDiagnostics::CycleDiagnostics(Bus& bus, double rate)
    : bus_(bus),
      rate_(rate),
      diagnostics_(bus),
      intervals_(2 / rate),
      statistics_(bus.advertise<cell_microinjection::CycleStatistics>("/cycle_statistics", 10)) {
  diagnostics_.add("cycle", [this](DiagnosticStatusWrapper& status) { reportCycle(status); });
  diagnostics_.add("inputs", [this](DiagnosticStatusWrapper& status) { reportInputs(status); });
}

void CycleDiagnostics::add(const std::string& name, const std::function<void(DiagnosticStatusWrapper&)>& report) {
  diagnostics_.add(name, report);
}

void CycleDiagnostics::beginStep() {
  const ros::SteadyTime now = bus_.steady();
  if (!step_began_.isZero()) intervals_.add(secondsBetween(step_began_, now));
  step_began_ = now;
}

void CycleDiagnostics::endStep(const ros::Time& now) {
  const double took = secondsBetween(step_began_, bus_.steady());
  ++steps_;
  ++all_steps_;
  step_time_ += took;
  longest_step_ = std::max(longest_step_, took);
  now_ = now;
  if (began_.isZero()) began_ = reported_ = now;
  if (!diagnostics_.update()) return;
  publishStatistics();
  reported_ = now;
  steps_ = 0;
  step_time_ = longest_step_ = 0;
}

void CycleDiagnostics::publishStatistics() {
  cell_microinjection::CycleStatistics statistics;
  statistics.header.stamp = now_;
  statistics.node = bus_.name().substr(1);
  if (!outputs_.empty()) statistics.topic = bus_.resolve(outputs_.front()->topic);
  statistics.steps = all_steps_;
  statistics.mean_rate = static_cast<double>(all_steps_ - 1) / std::max(1e-9, secondsBetween(began_, now_));
  statistics.median_interval = intervals_.quantile(0.5);
  statistics.p99_interval = intervals_.quantile(0.99);
  statistics_.publish(statistics);
}

void CycleDiagnostics::reportCycle(DiagnosticStatusWrapper& status) {
  const double reached = steps_ / std::max(1e-9, secondsBetween(reported_, now_));
  const bool slow = reached < 0.9 * rate_;
  status.summary(slow ? DiagnosticStatus::WARN : DiagnosticStatus::OK, slow ? "rate is too low" : "runs at its rate");
  status.add("rate (Hz)", reached);
  status.add("nominal rate (Hz)", rate_);
  status.add("mean step time (s)", step_time_ / std::max(1u, steps_));
  status.add("longest step time (s)", longest_step_);
  status.add("steps since the start", all_steps_);
  reportIntervals(intervals_, status);
  reportOutputs(status);
}

void CycleDiagnostics::reportOutputs(DiagnosticStatusWrapper& status) {
  unsigned all_withheld = 0;
  for (const OutputPort* output : outputs_) {
    status.add("sent on " + output->topic, output->count);
    if (output->withheld == 0) continue;
    all_withheld += output->withheld;
    status.add("withheld on " + output->topic + ", not finite", output->withheld);
  }
  if (all_withheld > withheld_) {
    status.mergeSummary(DiagnosticStatus::ERROR, "a value that is not finite was withheld");
  }
  withheld_ = all_withheld;
}

void CycleDiagnostics::reportIntervals(const IntervalHistogram& intervals, DiagnosticStatusWrapper& status) {
  status.add("median interval since the start (s of wall time)", intervals.quantile(0.5));
  status.add("99 % interval since the start (s of wall time)", intervals.quantile(0.99));
  status.add("intervals since the start", intervals.count());
  status.add("intervals of more than two periods", intervals.countOverLimit());
  std::string text;
  for (const IntervalHistogram::Bin& bin : intervals.bins()) {
    char entry[40];
    std::snprintf(entry, sizeof(entry), "%.4g:%u ", bin.upper, bin.count);
    text += entry;
  }
  status.add("intervals up to (s):count", text);
}

/// As the node's documents name it, or as it is remapped.
std::string CycleDiagnostics::nameOf(const std::string& topic) const {
  const std::string resolved = bus_.resolve(topic);
  return resolved == "/" + topic ? topic : resolved;
}

void CycleDiagnostics::reportInputs(DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "all inputs are fresh");
  const auto disconnected = [](const InputPort* input) { return input->disconnected; };
  if (std::any_of(inputs_.begin(), inputs_.end(), disconnected)) {
    return status.summary(DiagnosticStatus::ERROR, "the ROS master is lost: no input counts");
  }
  for (const InputPort* input : inputs_) {
    const std::string topic = nameOf(input->topic);
    status.add("age of " + topic + " (s)", input->age(now_));
    const bool may_be_silent = input->optional || std::isinf(input->timeout);  // a command may never arrive
    if (input->received.isZero() && may_be_silent) continue;
    const std::string rivals = input->rivals(now_);
    if (!rivals.empty()) {
      status.mergeSummary(DiagnosticStatus::ERROR,
                          topic + " is sent by two nodes, " + rivals + ": none counts until one has stopped");
    } else if (!input->repeats.empty()) {
      status.mergeSummary(DiagnosticStatus::ERROR, topic + " repeats " + input->repeats);
    } else if (!input->fresh(now_)) {
      status.mergeSummary(DiagnosticStatus::WARN, topic + (input->valid() ? " is stale" : " has nothing valid"));
    }
  }
  bus_.refusals().report(status);
}

}  // namespace microinjection
