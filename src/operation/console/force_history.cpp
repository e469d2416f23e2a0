#include "operation/console/force_history.h"

#include <cstddef>
#include <utility>

namespace microinjection {
namespace {

constexpr double kMicro = 1e-6;

/// Keeps the length of a line bounded in a contact of any duration.
void append(PlotLine& line, PlotPoint point) {
  if (line.size() >= ForceHistory::kMostPoints) {
    for (std::size_t i = 0; 2 * i < line.size(); ++i) line[i] = line[2 * i];
    line.resize((line.size() + 1) / 2);
  }
  line.push_back(point);
}

}  // namespace

void ForceHistory::add(const Sample& sample) {
  // A clock that was set back would mix two times in one line.
  if (!samples_.empty() && sample.time < samples_.back().time) samples_.clear();
  samples_.push_back(sample);
  while (samples_.front().time < sample.time - kWindow) samples_.pop_front();
  if (sample.depth && !in_contact_) beginContact();
  in_contact_ = sample.depth.has_value();
  if (!in_contact_) return;
  const double depth = *sample.depth / kMicro;
  if (sample.predicted) append(predicted_, {depth, *sample.predicted / kMicro});
  if (sample.measured) append(measured_, {depth, *sample.measured / kMicro});
}

void ForceHistory::beginContact() {
  PlotLine& last = measured_.empty() ? predicted_ : measured_;
  if (!last.empty()) past_.push_back(std::move(last));
  if (past_.size() > kPastContacts) past_.pop_front();
  predicted_.clear();
  measured_.clear();
  ++contacts_;
}

PlotLine ForceHistory::overTime(std::optional<double> Sample::*force) const {
  PlotLine line;
  line.reserve(samples_.size());
  for (const Sample& sample : samples_) {
    if (sample.*force) line.push_back({sample.time - samples_.back().time, *(sample.*force) / kMicro});
  }
  return line;
}

PlotLine ForceHistory::predictedOverTime() const { return overTime(&Sample::predicted); }
PlotLine ForceHistory::measuredOverTime() const { return overTime(&Sample::measured); }

}  // namespace microinjection
