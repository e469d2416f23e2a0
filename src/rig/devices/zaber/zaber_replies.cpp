// What ZaberDriver makes of what the devices say.

#include <algorithm>
#include <cmath>

#include "rig/devices/zaber/zaber_driver.h"

namespace microinjection {
namespace {

constexpr double kRetryPause = 0.02;  // s, after AGAIN and its like
constexpr int kTries = 3;             // of a message
constexpr int kStalls = 10;           // readings of an axis at rest that was told to move
constexpr int kMostLists = 20;        // of warnings, without a position between them

}  // namespace

/// Whether it answers what was asked last. An axis that the device does not have is refused by the device.
bool ZaberDriver::isAwaited(const ZaberMessage& reply) const {
  if (!exchange_ || !exchange_->sent || (config_.numbers && reply.number != number_)) return false;
  const ZaberAddress device{exchange_->to.device, 0};
  return reply.from == exchange_->to || (reply.rejected && reply.from == device);
}

void ZaberDriver::handle(const ZaberMessage& message) {
  const int axis = axisOf(message.from);
  if (message.kind == ZaberMessage::Kind::kReply) {
    if (isAwaited(message)) handleReply(message);
  } else if (message.kind == ZaberMessage::Kind::kAlert && axis >= 0) {
    takeFlag(message.flag, axis);
  }
}

/// A flag that a reply shows, the most important one.
void ZaberDriver::takeFlag(const std::string& flag, int i) {
  const bool told_already = state() == State::kFault && !clearing();
  if (isZaberFault(flag)) {
    if (!told_already) raiseFault(axisName(i) + " reports fault " + flag);
    return;
  }
  if (flag == kZaberNoReference) return loseReference(i);
  Axis& axis = axes_[i];
  if (!mayHideZaberReference(flag)) {
    axis.has_reference = true;  // WR would be shown
    axis.shown.clear();
  } else if (flag != axis.shown) {
    axis.lists_due = std::max(axis.lists_due, 1);
  }
}

/// At the begin of a session homing may be allowed; later the device was switched off, or its encoder has failed: what
/// it counts from now on is no position.
void ZaberDriver::loseReference(int i) {
  axes_[i].has_reference = false;
  if (!settled_ || state() == State::kFault) return;
  raiseFault(axisName(i) + " has lost its reference position (WR): was it switched off? Home it");
}

void ZaberDriver::takeWarnings(const Exchange& asked, const ZaberMessage& reply) {
  Axis& axis = axes_[asked.axis];
  const bool told_already = state() == State::kFault && !clearing();
  if (!told_already && ++axis.lists > kMostLists) {
    return raiseFault(axisName(asked.axis) + ": its warnings do not stay the same, the last are \"" + reply.data +
                      "\": behind them a lost reference position could hide");
  }
  const bool twice = axis.listed == reply.data;
  axis.listed = reply.data;
  if (axis.lists_due > 1 || (!twice && !settled_)) {
    axis.lists_due = 1;  // a damaged list would let a needle move that must not
    return;
  }
  axis.lists_due = 0;
  axis.listed.clear();
  axis.shown = mayHideZaberReference(reply.flag) ? reply.flag : "";
  bool referenced = reply.flag != kZaberNoReference;
  const std::vector<std::string> flags = reply.flags().value_or(std::vector<std::string>());
  for (const std::string& flag : flags) {
    referenced = referenced && flag != kZaberNoReference;
    if (!isZaberFault(flag)) continue;
    takeFlag(flag, asked.axis);
    if (!exchanging()) return;
  }
  if (!referenced) return loseReference(asked.axis);
  axis.has_reference = true;
}

void ZaberDriver::handleReply(const ZaberMessage& reply) {
  const Exchange done = *exchange_;
  if (reply.rejected) return handleRejection(reply);
  // A belated answer to something else; its own is still to come.
  if (done.kind == Kind::kPosition && !reply.position()) return;
  if (done.kind == Kind::kWarnings && !reply.flags()) return;
  if (!settled_ && (config_.numbers || done.tries == 1)) {
    answers_.add(listened() - done.heard_from - static_cast<double>(reply.size) * config_.byteTime());
  }
  understood();
  exchange_.reset();
  if (done.kind == Kind::kSetting) return takeSetting(done, reply.data);
  if (done.kind == Kind::kWarnings) return takeWarnings(done, reply);
  if (done.kind != Kind::kClear) takeFlag(reply.flag, done.axis);
  if (exchanging()) takeReply(done, reply);
}

void ZaberDriver::takeReply(const Exchange& done, const ZaberMessage& reply) {
  Axis& axis = axes_[done.axis];
  axis.busy = reply.busy;
  const double speed_unit = config_.microsteps_per_metre[done.axis] * kZaberSpeedUnit;  // for 1 m/s
  switch (done.kind) {
    case Kind::kPosition:
      axis.still_moves = reply.busy;
      if (!axis.has_reference || axis.lists_due > 0) break;
      axis.lists = 0;
      takePosition(done, reply);
      break;
    case Kind::kVelocity:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.velocity = done.value / speed_unit;
      axis.end = done.end;
      axis.told = done.value;
      axis.read_since_report = false;
      break;
    case Kind::kMove:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.end = done.value / config_.microsteps_per_metre[done.axis];
      axis.velocity = std::copysign(axis.move_speed, axis.end - *axis.position);
      axis.told.reset();
      axis.read_since_report = false;
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
      axis.still_moves = false;  // until it says otherwise
      break;
    case Kind::kHome:
      axis.homed = axis.busy = true;
      break;
    case Kind::kWarnings:
    case Kind::kSetting:
      break;  // taken before
  }
}

void ZaberDriver::handleRejection(const ZaberMessage& reply) {
  const Exchange refused = *exchange_;
  if (reply.from == refused.to && refused.kind != Kind::kSetting) takeFlag(reply.flag, refused.axis);
  if (!exchanging()) return;
  // It is busy, or the command reached it damaged. A rejected command has done nothing and may be said again.
  const bool later = reply.data == "AGAIN" || reply.data == "STATUSBUSY" || reply.data == "FULL";
  const bool damaged = reply.data == "BADCOMMAND";
  if ((later || damaged) && refused.tries < kTries) {
    exchange_->sent = false;
    exchange_->due = listened() + kRetryPause;
    return;
  }
  const auto setting = static_cast<ZaberSettings::Name>(refused.value);
  if (refused.kind == Kind::kSetting && damaged && ZaberSettings::mayBeUnknown(setting)) {
    exchange_.reset();
    return axes_[refused.axis].settings.takeUnknown(setting);
  }
  raiseFault(axisName(refused.axis) + " refuses \"" + refused.text + "\": " + reply.data);
}

void ZaberDriver::takePosition(const Exchange& asked, const ZaberMessage& reply) {
  const int i = asked.axis;
  Axis& axis = axes_[i];
  const double place = *reply.position() / config_.microsteps_per_metre[i];
  // When it was there: soon after it had the command. What a slow adapter holds back is the answer.
  const double then =
      std::min(asked.heard_at + config_.answer_time / 2, time() - static_cast<double>(reply.size) * config_.byteTime());
  const double guess = expected(i, then);
  const double step = 1 / config_.microsteps_per_metre[i];
  const double since = std::clamp(time() - axis.position_time, 0.0, longestGuess()) + exchangeTime();
  const bool rests = !reply.busy && axis.velocity == 0;
  const double tolerance =
      rests ? std::max(2.5 * step, axis.coasting) : config_.reading_margin + std::abs(axis.velocity) * since;
  const double agreement = reply.busy ? config_.reading_margin / 2 + config_.speed * turnTime() : 2.5 * step;
  using Coordinate = Eigen::VectorXd;
  if (!axis.filter.accept(Coordinate::Constant(1, place), Coordinate::Constant(1, guess), tolerance, agreement)) return;
  if (axis.read_since_begin) largest_correction_ = std::max(largest_correction_, std::abs(place - guess));
  const bool stands = axis.position && std::abs(place - *axis.position) < 0.5 * step;
  if (!reply.busy) axis.coasting = 0;
  axis.position = place;
  axis.position_time = then;
  axis.heard = listened();
  validityTime(std::min({axes_[0].heard, axes_[1].heard, axes_[2].heard}) + longestAge() - listened());
  axis.read_since_begin = axis.read_since_report = true;
  if (!reply.busy && axis.told.value_or(0) != 0) return checkStall(i, stands);
  axis.stalls = 0;
}

/// An axis at rest that was told a velocity has stopped by itself, or by hand: it is told again, a few times.
void ZaberDriver::checkStall(int i, bool stands) {
  Axis& axis = axes_[i];
  axis.told.reset();
  axis.velocity = 0;
  axis.stalls = stands ? axis.stalls + 1 : 0;
  if (axis.stalls >= kStalls) raiseFault(axisName(i) + " does not move although it is told to; is it at its end?");
}

void ZaberDriver::missedReply() {
  // Positions, speeds and moves to a place may be said twice; what a belated answer could spoil is checked elsewhere.
  if (exchange_->tries < kTries) return sendExchange();
  const std::string unchecked = parser_.unchecked() > 0 ? "; replies came without a checksum: set the device's "
                                                          "comm.checksum to 1, or reply_checksum to false"
                                                        : "";
  const Exchange lost = *exchange_;
  lostStep("no answer of " + axisName(lost.axis) + " to \"" + lost.text + "\"" + unchecked);
}

}  // namespace microinjection
