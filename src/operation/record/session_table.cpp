#include "operation/record/session_table.h"

#include <algorithm>
#include <cstdlib>

namespace microinjection {
namespace {

constexpr Nanoseconds kStale = 50000000;  ///< ns past which poses and forces are stale
constexpr Nanoseconds kForever = std::numeric_limits<Nanoseconds>::max();
constexpr Nanoseconds kLongestStep = 60000000000;  ///< ns between two calls, above which the clock was set

template <typename Entry>
auto valueOf(const Entry* entry) {
  return entry ? entry->value : decltype(entry->value)();
}

}  // namespace

const char* const SessionTable::kHeader =
    "time_s,phase,depth_m,predicted_axial_N,measured_axial_N,measured_lateral_N,hand_force_N,in_contact,punctured,"
    "tip_x_m,tip_y_m,tip_z_m,layers_punctured,injection_state,injected_volume_m3,punctures_felt\n";

SessionTable::SessionTable(Nanoseconds period, Nanoseconds max_delay, Sink sink)
    : period_(period), max_delay_(max_delay), sink_(std::move(sink)) {
  line_.precision(9);
}

double SessionTable::duration() const {
  return began_ && next_ > *began_ ? 1e-9 * static_cast<double>(next_ - period_ - *began_) : 0;
}

void SessionTable::advance(Nanoseconds now) {
  if (!began_) {
    began_ = now;
    next_ = now;
    seen_ = now;
  }
  if (std::abs(now - seen_) > kLongestStep) skipTo(now);
  seen_ = now;
  advanceTo(now - max_delay_);
}

/// The clock was set. There are no messages for the rows in between, which might fill the disk.
/// Values received before a clock was set back are invalid.
void SessionTable::skipTo(Nanoseconds now) {
  if (now > seen_) {
    advanceTo(seen_);
  } else {
    clear();
  }
  const Nanoseconds due = std::max(*began_, now - max_delay_);
  next_ = *began_ + (due - *began_ + period_ - 1) / period_ * period_;
}

void SessionTable::finish() {
  if (began_) advanceTo(seen_);
}

void SessionTable::advanceTo(Nanoseconds end) {
  // Messages after the end are discarded, so that they do not fill the memory.
  if (done_) return discardBefore(end);
  for (; next_ <= end; next_ += period_) {
    const auto* latest = phase.at(next_, kForever);
    done_ = latest && *latest->value == "done";
    if (done_) return;
    const Row now = row(next_);
    write(now);
    if (row_handler_) row_handler_(now);
    discardBefore(next_);
  }
}

SessionTable::Row SessionTable::row(Nanoseconds time) {
  Row row;
  row.time = 1e-9 * static_cast<double>(time - *began_);
  const auto* force = predicted.at(time, kStale);
  row.needle = valueOf(needle.at(force ? force->stamp : time, kStale));
  if (force && row.needle) {
    row.predicted = force->value;
    in_contact_ = !force->value->isZero(0);
  }
  row.in_contact = in_contact_;
  row.measured = valueOf(measured.at(time, kStale));
  row.hand_force = valueOf(hand_force.at(time, kStale));
  row.phase = valueOf(phase.at(time, kForever)).value_or("");
  row.cell = valueOf(cell.at(time, kForever)).value_or(Cell());
  const Injection reported = valueOf(injection.at(time, kForever)).value_or(Injection());
  row.injection = reported.state;
  row.punctures = reported.punctures;
  row.volume = valueOf(volume.at(time, kStale));
  if (row.needle) row.depth = depth(time, *row.needle, row.predicted && in_contact_);
  return row;
}

std::optional<double> SessionTable::depth(Nanoseconds time, const Pose& pose, bool in_contact) {
  const auto* state = cell.at(time, kForever);
  if (state && state->value->contact_point) {
    contact_point_ = state->value->contact_point;
  } else if (in_contact) {
    // The cell's state is published less often than rows are written: contact began after the last
    // one.
    const auto* next = cell.firstAfter(time, [](const Cell& later) { return later.contact_point.has_value(); });
    contact_point_ = next ? next->value->contact_point : std::nullopt;
  }
  if (!contact_point_) return std::nullopt;
  return (*contact_point_ - pose.tip).dot(pose.axis);
}

void SessionTable::write(const Row& row) {
  line_.str("");
  const auto put = [this](const std::optional<double>& value) {
    if (value) line_ << *value;
    line_ << ',';
  };
  line_ << row.time << ',' << row.phase << ',';
  put(row.depth);
  put(row.predicted ? std::optional(row.predicted->dot(row.needle->axis)) : std::nullopt);
  put(row.measured ? std::optional(row.measured->axial) : std::nullopt);
  put(row.measured ? std::optional(row.measured->lateral) : std::nullopt);
  put(row.hand_force);
  line_ << row.in_contact << ',' << row.cell.punctured << ',';
  for (int i = 0; i < 3; ++i) put(row.needle ? std::optional(row.needle->tip[i]) : std::nullopt);
  line_ << row.cell.layers_punctured << ',' << row.injection << ',';
  put(row.volume);
  line_ << row.punctures << '\n';
  sink_(line_.str());
}

template <typename Function>
void SessionTable::forEachButNeedle(const Function& function) {
  const auto each = [&function](auto&... timelines) { (function(timelines), ...); };
  each(predicted, measured, hand_force, phase, cell, injection, volume);
}

void SessionTable::discardBefore(Nanoseconds time) {
  // A row's pose has the stamp of its force, which may be older than the row by kStale.
  needle.discardBefore(time - 2 * kStale);
  forEachButNeedle([time](auto& timeline) { timeline.discardBefore(time); });
}

void SessionTable::clear() {
  needle = {};
  forEachButNeedle([](auto& timeline) { timeline = {}; });
}

}  // namespace microinjection
