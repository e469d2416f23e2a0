#include "record/session_table.h"

namespace microinjection {
namespace {

constexpr Nanoseconds kStale = 50000000;  ///< ns past which poses and forces are not believed
constexpr Nanoseconds kForever = std::numeric_limits<Nanoseconds>::max();

template <typename Value>
const Value* valueOf(const typename Timeline<Value>::Entry* entry) {
  return entry ? &*entry->value : nullptr;
}

}  // namespace

SessionTable::SessionTable(Nanoseconds period, Nanoseconds patience) : period_(period), patience_(patience) {
  rows_.precision(9);
  rows_ << "time_s,phase,depth_m,predicted_axial_N,measured_axial_N,measured_lateral_N,hand_force_N,in_contact,"
           "punctured,tip_x_m,tip_y_m,tip_z_m,layers_punctured,injection_state,injected_volume_m3\n";
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
    writeRow(next_);
    forgetBefore(next_);
  }
}

void SessionTable::writeRow(Nanoseconds time) {
  const auto* force = predicted.at(time, kStale);
  const Pose* pose = valueOf<Pose>(needle.at(force ? force->stamp : time, kStale));
  const Measured* sensed = valueOf<Measured>(measured.at(time, kStale));
  const double* felt = valueOf<double>(hand_force.at(time, kStale));
  const std::string* name = valueOf<std::string>(phase.at(time, kForever));
  const Cell* state = valueOf<Cell>(cell.at(time, kForever));
  if (force && pose) in_contact_ = !force->value->isZero(0);
  rows_ << 1e-9 * static_cast<double>(time - *began_) << ',' << (name ? *name : "") << ',';
  if (pose) writeDepth(time, *pose, force && in_contact_);
  rows_ << ',';
  if (force && pose) rows_ << force->value->dot(pose->axis);
  rows_ << ',';
  if (sensed) rows_ << sensed->axial << ',' << sensed->lateral << ',';
  if (!sensed) rows_ << ",,";
  if (felt) rows_ << *felt;
  rows_ << ',' << in_contact_ << ',' << (state && state->punctured) << ',';
  if (pose) rows_ << pose->tip.x() << ',' << pose->tip.y() << ',' << pose->tip.z();
  rows_ << (pose ? "" : ",,") << ',' << (state ? state->layers_punctured : 0) << ',';
  if (const auto* injecting = valueOf<std::string>(injection.at(time, kForever))) rows_ << *injecting;
  rows_ << ',';
  if (const double* out = valueOf<double>(volume.at(time, kStale))) rows_ << *out;
  rows_ << '\n';
}

void SessionTable::writeDepth(Nanoseconds time, const Pose& pose, bool in_contact) {
  const Cell* state = valueOf<Cell>(cell.at(time, kForever));
  if (state && state->touched_at) {
    touched_at_ = state->touched_at;
  } else if (in_contact) {
    // The cell speaks less often than there are rows: it was touched since it last did.
    const auto* next = cell.firstAfter(time, [](const Cell& later) { return later.touched_at.has_value(); });
    touched_at_ = next ? next->value->touched_at : std::nullopt;
  }
  if (touched_at_) rows_ << (*touched_at_ - pose.tip).dot(pose.axis);
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
