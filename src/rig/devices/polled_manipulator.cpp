#include "rig/devices/polled_manipulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

namespace microinjection {
namespace {

constexpr int kSetupTries = 6;    // for a setup line, which needs two equal replies
constexpr int kSettingTries = 3;  // of a setting that the device acknowledges, and does not have
constexpr std::size_t kLongestReply = 80;

std::string printable(const std::string& text) {
  std::string result;
  for (const char each : text.substr(0, 40)) {
    result += std::isprint(static_cast<unsigned char>(each)) ? each : each == '\t' ? ' ' : '?';
  }
  return result;
}

}  // namespace

void PolledManipulatorConfig::readCommon(ConfigReader& reader, int default_baud, const Range& speeds) {
  MoveByMoveConfig::readCommon(reader, default_baud, speeds, {0.05, 60});
  reader.number("reading_margin", reading_margin, Range::positive());
}

PolledManipulator::PolledManipulator(const PolledManipulatorConfig& config, std::unique_ptr<Wire> wire,
                                     const Dialect& dialect)
    : MoveByMove(config, std::move(wire),
                 {dialect.short_name, dialect.guarded_stop,
                  std::max(config.answer_time, kHeldReply) + dialect.stop_duration + 20 * config.byteTime() + 5e-3,
                  config.reply_timeout + dialect.longest_move * config.byteTime(), dialect.farewell},
                 dialect.longest_move),
      reading_margin_(config.reading_margin),
      dialect_(dialect),
      lines_("\r", kLongestReply) {}

ManipulatorAbilities PolledManipulator::abilities() const {
  const double reading = dialect_.longest_reading * common_.byteTime() + answer_time_;
  const double turn = dialect_.longest_move * common_.byteTime() + dialect_.move_replies * answer_time_ +
                      common_.segment_time + 2 * reading;
  ManipulatorAbilities abilities = abilitiesWith(turn);
  abilities.device = dialect_.device;
  abilities.stop_time += dialect_.stop_duration;
  return abilities;
}

/// A reply and a reading, or two readings, and some reserve.
double PolledManipulator::extrapolationTime() const {
  return kExtrapolatedMotion + 2 * (dialect_.longest_reading * common_.byteTime() + answer_time_);
}

/// Silence after a failed exchange, the setup of a new session, and one turn as reserve.
double PolledManipulator::recoveryTime() const {
  constexpr int kLineAndReply = 20, kReadings = 4;  // bytes of a setup line; readings until it rests
  int lines = 2;
  for (int i = 0; !setup(i).empty(); ++i) lines += isReadBack(i) ? 4 : 2;
  return common_.reply_timeout + dialect_.longest_move * common_.byteTime() + dialect_.stop_duration +
         lines * (kLineAndReply * common_.byteTime() + answer_time_) +
         kReadings * (dialect_.longest_reading * common_.byteTime() + answer_time_) + abilities().reading_interval;
}

void PolledManipulator::begin(bool lost) {
  MoveByMove::begin(lost);
  exchange_.reset();
  lines_.clear(false);
  stop_requested_ = motion_requested_ = false;
  check_setting_ = lost && !confirmed_.empty();
  lost_setting_replies_ = 0;
  if (lost) forgetSettings();
}

/// The device may have lost its settings.
void PolledManipulator::forgetSettings() {
  setup_step_ = setup_tries_ = setup_unset_ = 0;
  setup_sent_ = false;
  setup_reply_.reset();
  setting_.clear();
}

void PolledManipulator::onStopSent() {
  MoveByMove::onStopSent();
  next_move_ = 0;
}

void PolledManipulator::exchange(const std::string& bytes) {
  for (const std::string& line : lines_.feed(bytes)) {
    const std::string reply = !line.empty() && line[0] == '\n' ? line.substr(1) : line;
    handle(reply);
    if (!exchanging()) return;
  }
  // In motion it is stopped as soon as a reading is overdue, and asked again at rest.
  if (exchange_ && exchange_->kind != Kind::kMove && isUnderWay() && overdue_ < kMostOverdue &&
      activeTime() > exchange_->sent + extrapolationTime()) {
    ++overdue_;
    return stopUnheard();
  }
  if (exchange_ && activeTime() > exchange_->due) return exchangeFailed("no reply to \"" + exchange_->line + "\"");
  if (!exchange_) next();
}

void PolledManipulator::handleMalformedReply(const std::string& reply) {
  ++malformed_;
  exchangeFailed(exchange_ ? "answers \"" + printable(reply) + "\" to \"" + exchange_->line + "\""
                           : "sends \"" + printable(reply) + "\" without a request");
}

void PolledManipulator::handle(const std::string& reply) {
  if (!exchange_) return handleMalformedReply(reply);
  measure(exchange_->sent, reply.size() + 1);
  switch (exchange_->kind) {
    case Kind::kSetup:
      return handleSetupReply(reply);
    case Kind::kPosition:
      return handlePosition(reply);
    case Kind::kMotion:
      return handleMotion(reply);
    case Kind::kSettingCheck:
      exchangeSucceeded();
      exchange_.reset();
      if (!isKept(confirmed_, reply)) return handleLostSetting();
      check_setting_ = false;
      return;
    case Kind::kReadBack:
      return handleReadBack(reply);
    case Kind::kStop:
    case Kind::kSetting:
    case Kind::kMove:
      if (!acknowledges(exchange_->line, reply)) return handleMalformedReply(reply);
      exchangeSucceeded();
      if (exchange_->kind == Kind::kStop) stop_requested_ = true;
      if (exchange_->kind == Kind::kSetting) {
        confirmed_ = exchange_->line;
        progress_.setting_sent = true;
      }
      if (exchange_->kind == Kind::kMove) origin_monitor_.confirmMove();
      exchange_.reset();
  }
}

void PolledManipulator::handleSetupReply(const std::string& reply) {
  const bool twice = setup_reply_ == reply;
  if (!twice && ++setup_tries_ > kSetupTries) return handleMalformedReply(reply);
  if (!twice && setup_reply_) ++malformed_;
  exchange_.reset();
  setup_reply_ = reply;
  if (!twice) return;
  setup_reply_.reset();
  setup_tries_ = 0;
  const std::string line = setup(setup_step_);
  if (setup_sent_ && !isKept(line, reply)) {
    setup_sent_ = false;
    return handleUnset(line, reply, ++setup_unset_);
  }
  if (!setup_sent_) {
    const std::string refusal = handleSetup(setup_step_, reply);
    if (!refusal.empty()) return raiseFault("answers \"" + printable(reply) + "\" to \"" + line + "\": " + refusal);
    setup_sent_ = isReadBack(setup_step_);
    if (setup_sent_) return exchangeSucceeded();
  }
  setup_sent_ = false;
  setup_unset_ = 0;
  ++setup_step_;
  if (setup(setup_step_).empty()) confirmed_ = line;  // the requests before it set nothing
  exchangeSucceeded();
}

/// Needs two such replies, since one may be damaged.
void PolledManipulator::handleLostSetting() {
  if (++lost_setting_replies_ < 2) return;
  check_setting_ = false;
  settings_lost_ = true;
}

/// The setting of a move, which is not sent before. One reply without it may be damaged; after two the setting is sent
/// again, since its line may have been.
void PolledManipulator::handleReadBack(const std::string& reply) {
  exchangeSucceeded();
  exchange_.reset();
  if (isKept(progress_.setting, reply)) {
    setting_ = std::exchange(progress_.setting, "");
    return;
  }
  if (++progress_.unset_replies < 2) return;
  progress_.unset_replies = 0;
  progress_.setting_sent = false;
  handleUnset(progress_.setting, reply, ++progress_.setting_tries);
}

/// Handles a setting that the device has acknowledged, and does not have: it is sent again, a few times.
void PolledManipulator::handleUnset(const std::string& setting, const std::string& reply, int tries) {
  if (tries < kSettingTries) return;
  raiseFault("it does not keep the setting \"" + setting + "\": it answers \"" + printable(reply) + "\" to \"" +
             settingQuery(setting) + "\"; check cable and port, then enable");
}

void PolledManipulator::handleMotion(const std::string& reply) {
  const std::optional<bool> moves = readMotion(reply);
  if (!moves) return handleMalformedReply(reply);
  exchange_.reset();
  exchangeSucceeded();
  motion_requested_ = true;
  if (!move_) return;
  if (*moves) {
    progress_.at_rest_since.reset();
  } else if (!progress_.at_rest_since) {
    progress_.at_rest_since = activeTime();
  }
}

void PolledManipulator::handlePosition(const std::string& reply) {
  const std::optional<Eigen::Vector3d> position = readPosition(reply);
  if (!position) return handleMalformedReply(reply);
  exchange_.reset();
  motion_requested_ = false;
  exchangeSucceeded();
  if (isTooFar(*position)) return handleTooFast();
  updatePosition(*position);
}

void PolledManipulator::updatePosition(const Eigen::Vector3d& position) {
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  const Eigen::Vector3d expected = position_ && settled_ ? extrapolatedPosition(time()) : nowhere;
  const double speed = move_ ? (move_->to - move_->from).norm() / std::max(move_->duration, 1e-3) : 0;  // counts/s
  const double under_way = reading_margin_ / count() + kExtrapolatedMotion * speed;
  // At rest, or before rest is confirmed, only four equal readings can change the position.
  const double tolerance = move_ ? under_way : kSame;
  const bool on_line = !move_ || besideTheLine(position) <= line_margin_;
  if (!filter_.accept(position, on_line ? expected : nowhere, tolerance, tolerance) || !reply_times_.measured()) {
    if (move_ && filter_.isContradicted()) contradicted(position);
    return;  // requested again
  }
  const bool elsewhere = !((position - expected).cwiseAbs().maxCoeff() <= tolerance);
  const bool jumped = move_ && elsewhere && position.isZero(kSame);
  const bool new_zero = jumped || ((!move_ || settings_lost_) && isNewZero(position, reading_margin_));
  const bool by_hand = dialect_.moved_by_hand && settled_ && !move_;
  if (detectNewOrigin(position, by_hand ? 0 : origin_monitor_.outside(position, counts()), new_zero, reading_margin_))
    return;
  if (move_) {
    extrapolateFor(extrapolationTime());
    return checkMove(position);
  }
  if (interrupted_ && faultAstray(position)) return;
  if (settled_) {
    if (elsewhere) forgetSettings();
    return rest(position);
  }
  settled_ = true;
  rest(position);
  confirmPositions();
}

/// Handles a second reading in a row that is not where the move should be. A device that goes
/// elsewhere must be stopped now. For one that stands, on its line or at the 0 of a device that was
/// switched off, there is time until four readings agree.
void PolledManipulator::contradicted(const Eigen::Vector3d& position) {
  if (position.isZero(kSame)) return;
  if (detectNewOrigin(position, origin_monitor_.outside(position, counts()), false, reading_margin_)) return;
  faultAstray(position);
}

/// A limit switch that stops one axis is told by its name.
bool PolledManipulator::faultAstray(const Eigen::Vector3d& position) {
  const std::string reason = notArrivedReason();
  if (reason.empty() || besideTheLine(position) <= line_margin_) {
    return faultBesideTheLine(position, line_margin_);
  }
  raiseFault(kNotArrived + reason);
  return true;
}

void PolledManipulator::request(Kind kind, const std::string& line) {
  const double sent = activeTime() + static_cast<double>(line.size() + 1) * common_.byteTime();
  const double wire = static_cast<double>(std::max(dialect_.longest_reading, line.size())) * common_.byteTime();
  const bool may_stop = kind == Kind::kSettingCheck || kind == Kind::kStop || kind == Kind::kSetup;
  const double more = may_stop ? dialect_.stop_duration : 0;
  exchange_ = Exchange{kind, line, sent + wire + common_.reply_timeout + more, sent};
  const double once_more = isUnderWay() ? common_.reply_timeout : 0;  // it may be stopped before
  if (settled_ && !filter_.isImplausible()) validityTime(exchange_->due - activeTime() + once_more + recoveryTime());
  send(line + "\r");
}

void PolledManipulator::next() {
  if (check_setting_) return request(Kind::kSettingCheck, settingQuery(confirmed_));
  if (const std::string line = setup(setup_step_); !line.empty()) {
    return request(Kind::kSetup, setup_sent_ ? settingQuery(line) : line);
  }
  if (!stop_requested_) return request(Kind::kStop, dialect_.stop);
  if (!settled_ || filter_.isImplausible()) return request(Kind::kPosition, dialect_.position);
  if (move_) return nextOfMove();
  if (goal() && mayMove() && time() >= next_move_ && !isAt(*position_, goalPosition())) {
    return nextTowardsGoal();
  }
  if (time() >= next_rest_reading_) request(Kind::kPosition, dialect_.position);
}

}  // namespace microinjection
