#include "record/session_table.h"

namespace microinjection {
namespace {

constexpr Nanoseconds kStale = 50000000;  ///< ns past which poses and forces are not believed
constexpr Nanoseconds kForever = std::numeric_limits<Nanoseconds>::max();

template <typename Entry>
auto valueOf(const Entry* entry) {
  return entry ? entry->value : decltype(entry->value)();
}

}  // namespace

SessionTable::SessionTable(Nanoseconds period, Nanoseconds patience) : period_(period), patience_(patience) {
  rows_.precision(9);
  rows_ << "time_s,phase,depth_m,predicted_axial_N,measured_axial_N,measured_lateral_N,hand_force_N,in_contact,"
           "punctured,tip_x_m,tip_y_m,tip_z_m,layers_punctured,injection_state,injected_volume_m3,punctures_felt\n";
}

double SessionTable::duration() const {
  return began_ && next_ > *began_ ? 1e-9 * static_cast<double>(next_ - period_ - *began_) : 0;
}

void SessionTable::advance(Nanoseconds now) {
  if (!began_) {
    began_ = now;
    next_ = now;
  }
  seen_ = now;
  advanceTo(now - patience_);
}

void SessionTable::finish() {
  if (began_) advanceTo(seen_);
}

void SessionTable::advanceTo(Nanoseconds end) {
  for (; !done_ && next_ <= end; next_ += period_) {
    const auto* said = phase.at(next_, kForever);
    done_ = said && *said->value == "done";
    if (done_) return;
    const Row now = row(next_);
    write(now);
    if (listener_) listener_(now);
    forgetBefore(next_);
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
  const Injection told = valueOf(injection.at(time, kForever)).value_or(Injection());
  row.injection = told.state;
  row.punctures = told.punctures;
  row.volume = valueOf(volume.at(time, kStale));
  if (row.needle) row.depth = depth(time, *row.needle, row.predicted && in_contact_);
  return row;
}

std::optional<double> SessionTable::depth(Nanoseconds time, const Pose& pose, bool in_contact) {
  const auto* state = cell.at(time, kForever);
  if (state && state->value->touched_at) {
    touched_at_ = state->value->touched_at;
  } else if (in_contact) {
    // The cell speaks less often than there are rows: it was touched since it last did.
    const auto* next = cell.firstAfter(time, [](const Cell& later) { return later.touched_at.has_value(); });
    touched_at_ = next ? next->value->touched_at : std::nullopt;
  }
  if (!touched_at_) return std::nullopt;
  return (*touched_at_ - pose.tip).dot(pose.axis);
}

void SessionTable::write(const Row& row) {
  const auto put = [this](const std::optional<double>& value) {
    if (value) rows_ << *value;
    rows_ << ',';
  };
  rows_ << row.time << ',' << row.phase << ',';
  put(row.depth);
  put(row.predicted ? std::optional(row.predicted->dot(row.needle->axis)) : std::nullopt);
  put(row.measured ? std::optional(row.measured->axial) : std::nullopt);
  put(row.measured ? std::optional(row.measured->lateral) : std::nullopt);
  put(row.hand_force);
  rows_ << row.in_contact << ',' << row.cell.punctured << ',';
  for (int i = 0; i < 3; ++i) put(row.needle ? std::optional(row.needle->tip[i]) : std::nullopt);
  rows_ << row.cell.layers_punctured << ',' << row.injection << ',';
  put(row.volume);
  rows_ << row.punctures << '\n';
}

void SessionTable::forgetBefore(Nanoseconds time) {
  // A row's pose has the stamp of its force, which may be older than the row by kStale.
  needle.forgetBefore(time - 2 * kStale);
  predicted.forgetBefore(time);
  measured.forgetBefore(time);
  hand_force.forgetBefore(time);
  phase.forgetBefore(time);
  cell.forgetBefore(time);
  injection.forgetBefore(time);
  volume.forgetBefore(time);
}

}  // namespace microinjection
