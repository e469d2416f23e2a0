// ZaberDriver: handles the devices' replies.

#include <algorithm>
#include <cmath>

#include "rig/devices/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kRetryPause = 0.02;  // s, after AGAIN and similar rejections
constexpr int kTries = 3;             // of a message
constexpr int kStalls = 10;           // readings of an axis at rest that should move
constexpr int kMostLists = 20;        // of warnings, without a position between them

}  // namespace

/// Whether it is the reply to the last request. The device itself rejects requests to an axis that
/// it does not have.
bool ZaberDriver::isExpectedReply(const ZaberMessage& reply) const {
  if (!exchange_ || !exchange_->sent || (config_.numbers && reply.number != number_)) return false;
  const ZaberAddress device{exchange_->to.device, 0};
  return reply.from == exchange_->to || (reply.rejected && reply.from == device);
}

/// A command is answered once. What a line that doubles bytes repeats is the same.
bool ZaberDriver::isOfTwin(const ZaberMessage& reply) {
  if (!answer_ || !answer_->number || reply.number != answer_->number || !(reply.from == answer_->from)) return false;
  if (reply.rejected == answer_->rejected && reply.data == answer_->data) return false;
  if (state() == State::kFault && !clearing()) return true;
  const std::string device = std::to_string(reply.from.device);
  raiseFault("one command has two answers of device " + device + ", \"" + answer_->data + "\" and \"" + reply.data +
             "\": two devices have the address " + device + ", and both would move. Connect them one by one and give " +
             "each an address of its own (set comm.address, or /renumber)");
  return true;
}

void ZaberDriver::handle(const ZaberMessage& message) {
  const int axis = axisOf(message.from);
  if (message.kind == ZaberMessage::Kind::kReply) {
    if (isOfTwin(message)) return;
    if (!isExpectedReply(message)) return;
    answer_ = message;
    handleReply(message);
  } else if (message.kind == ZaberMessage::Kind::kAlert && axis >= 0) {
    handleFlag(message.flag, axis);
  }
}

/// Handles the flag of a reply, which is the most important one.
void ZaberDriver::handleFlag(const std::string& flag, int i) {
  const bool already_reported = state() == State::kFault && !clearing();
  if (isZaberFault(flag)) {
    if (!already_reported) raiseFault(axisName(i) + " reports fault " + flag);
    return;
  }
  if (flag == kZaberNoReference) return loseReference(i);
  Axis& axis = axes_[i];
  if (!mayHideZaberReference(flag)) {
    axis.has_reference = true;  // WR would be shown
    axis.shown_flag.clear();
  } else if (flag != axis.shown_flag) {
    axis.lists_required = std::max(axis.lists_required, 1);
  }
}

/// At the start of a session homing may be allowed. Later the device was switched off, or its
/// encoder has failed, and its counts are no position.
void ZaberDriver::loseReference(int i) {
  axes_[i].has_reference = false;
  if (!settled_ || state() == State::kFault) return;
  raiseFault(axisName(i) + " has lost its reference position (WR): was it switched off? Home it");
}

void ZaberDriver::handleWarnings(const Exchange& request, const ZaberMessage& reply) {
  Axis& axis = axes_[request.axis];
  const bool already_reported = state() == State::kFault && !clearing();
  if (!already_reported && ++axis.lists > kMostLists) {
    return raiseFault(axisName(request.axis) + ": its warnings do not stay the same, the last are \"" + reply.data +
                      "\": behind them a lost reference position could hide");
  }
  const bool twice = axis.last_list == reply.data;
  axis.last_list = reply.data;
  if (axis.lists_required > 1 || (!twice && !settled_)) {
    axis.lists_required = 1;  // a damaged list could let a needle without reference move
    return;
  }
  axis.lists_required = 0;
  axis.last_list.clear();
  axis.shown_flag = mayHideZaberReference(reply.flag) ? reply.flag : "";
  bool referenced = reply.flag != kZaberNoReference;
  const std::vector<std::string> flags = reply.flags().value_or(std::vector<std::string>());
  for (const std::string& flag : flags) {
    referenced = referenced && flag != kZaberNoReference;
    if (!isZaberFault(flag)) continue;
    handleFlag(flag, request.axis);
    if (!exchanging()) return;
  }
  if (!referenced) return loseReference(request.axis);
  axis.has_reference = true;
}

void ZaberDriver::handleReply(const ZaberMessage& reply) {
  const Exchange done = *exchange_;
  if (reply.rejected) return handleRejection(reply);
  // A late reply to another request; the expected one is still to come.
  if (done.kind == Kind::kPosition && !reply.position()) return;
  if (done.kind == Kind::kWarnings && !reply.flags()) return;
  if (!settled_ && (config_.numbers || done.tries == 1)) {
    reply_times_.add(activeTime() - done.delivered_active_time - static_cast<double>(reply.size) * config_.byteTime());
  }
  exchangeSucceeded();
  exchange_.reset();
  if (done.kind == Kind::kSetting) return handleSetting(done, reply.data);
  if (done.kind == Kind::kWarnings) return handleWarnings(done, reply);
  if (done.kind != Kind::kClear) handleFlag(reply.flag, done.axis);
  if (exchanging()) applyReply(done, reply);
}

void ZaberDriver::applyReply(const Exchange& done, const ZaberMessage& reply) {
  Axis& axis = axes_[done.axis];
  axis.busy = reply.busy;
  const double speed_unit = config_.microsteps_per_metre[done.axis] * kZaberSpeedUnit;  // for 1 m/s
  switch (done.kind) {
    case Kind::kPosition:
      axis.reports_motion = reply.busy;
      if (!axis.has_reference || axis.lists_required > 0) break;
      axis.lists = 0;
      handlePosition(done, reply);
      break;
    case Kind::kVelocity:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.velocity = done.value / speed_unit;
      axis.end = done.end;
      axis.sent_velocity = done.value;
      axis.read_since_command = false;
      break;
    case Kind::kMove:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.end = done.value / config_.microsteps_per_metre[done.axis];
      axis.velocity = std::copysign(axis.move_speed, axis.end - *axis.position);
      axis.sent_velocity.reset();
      axis.read_since_command = false;
      ++move_stage_;
      break;
    case Kind::kSpeed:
      axis.move_speed = done.value / speed_unit;
      ++move_stage_;
      break;
    case Kind::kClear:
      axis.cleared = true;
      break;
    case Kind::kStop:
      axis.reports_motion = false;  // until it reports motion
      break;
    case Kind::kHome:
      axis.homed = axis.busy = true;
      break;
    case Kind::kWarnings:
    case Kind::kSetting:
      break;  // handled before
  }
}

void ZaberDriver::handleRejection(const ZaberMessage& reply) {
  const Exchange refused = *exchange_;
  if (reply.from == refused.to && refused.kind != Kind::kSetting) handleFlag(reply.flag, refused.axis);
  if (!exchanging()) return;
  // The device is busy, or the command was damaged. A rejected command had no effect and may be
  // repeated.
  const bool later = reply.data == "AGAIN" || reply.data == "STATUSBUSY" || reply.data == "FULL";
  const bool damaged = reply.data == "BADCOMMAND";
  if ((later || damaged) && refused.tries < kTries) {
    exchange_->sent = false;
    exchange_->due = activeTime() + kRetryPause;
    return;
  }
  const auto setting = static_cast<ZaberSettings::Name>(refused.value);
  if (refused.kind == Kind::kSetting && damaged && ZaberSettings::mayBeUnknown(setting)) {
    exchange_.reset();
    return axes_[refused.axis].settings.setUnsupported(setting);
  }
  raiseFault(axisName(refused.axis) + " refuses \"" + refused.text + "\": " + reply.data);
}

void ZaberDriver::handlePosition(const Exchange& request, const ZaberMessage& reply) {
  const int i = request.axis;
  Axis& axis = axes_[i];
  const double position = *reply.position() / config_.microsteps_per_metre[i];
  // The reading was taken soon after the device received the command. A slow adapter delays only
  // the reply.
  const double then = std::min(request.delivered_time + config_.answer_time / 2,
                               time() - static_cast<double>(reply.size) * config_.byteTime());
  const double extrapolated = expected(i, then);
  const double step = 1 / config_.microsteps_per_metre[i];
  const double since = std::clamp(time() - axis.position_time, 0.0, longestExtrapolation()) + exchangeTime();
  const bool rests = !reply.busy && axis.velocity == 0;
  const double tolerance =
      rests ? std::max(2.5 * step, axis.coasting) : config_.reading_margin + std::abs(axis.velocity) * since;
  const double agreement = reply.busy ? config_.reading_margin / 2 + config_.speed * turnTime() : 2.5 * step;
  using Coordinate = Eigen::VectorXd;
  if (!axis.filter.accept(Coordinate::Constant(1, position), Coordinate::Constant(1, extrapolated), tolerance,
                          agreement))
    return;
  const bool unchanged = axis.position && std::abs(position - *axis.position) < 0.5 * step;
  if (!reply.busy) axis.coasting = 0;
  axis.position = position;
  axis.position_time = then;
  axis.last_read = activeTime();
  validityTime(std::min({axes_[0].last_read, axes_[1].last_read, axes_[2].last_read}) + longestAge() - activeTime());
  axis.read_since_begin = axis.read_since_command = true;
  if (!reply.busy && axis.sent_velocity.value_or(0) != 0) return checkStall(i, unchanged);
  axis.stalls = 0;
}

/// An axis that rests despite a velocity has stopped by itself or was stopped by hand. The velocity
/// is repeated a few times.
void ZaberDriver::checkStall(int i, bool unchanged) {
  Axis& axis = axes_[i];
  axis.sent_velocity.reset();
  axis.velocity = 0;
  axis.stalls = unchanged ? axis.stalls + 1 : 0;
  if (axis.stalls >= kStalls) raiseFault(axisName(i) + " does not move at the commanded velocity; is it at its end?");
}

void ZaberDriver::missedReply() {
  // Positions, speeds and absolute moves may be repeated; the effect of a late reply is checked
  // elsewhere.
  if (exchange_->tries < kTries) return sendExchange();
  const std::string unchecked = parser_.unchecked() > 0 ? "; replies came without a checksum: set the device's "
                                                          "comm.checksum to 1, or reply_checksum to false"
                                                        : "";
  const Exchange lost = *exchange_;
  exchangeFailed("no reply of " + axisName(lost.axis) + " to \"" + lost.text + "\"" + unchecked);
}

}  // namespace microinjection
