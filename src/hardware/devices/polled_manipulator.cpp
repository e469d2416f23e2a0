#include "hardware/devices/polled_manipulator.h"

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

constexpr double kSettleTime = 0.2;  // s, in which a device that reports rest may still come to rest (acq4)
constexpr int kSteady = 2;           // successive readings at the goal
constexpr int kShorter = 5;          // attempts to shorten a part of the path

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

/// Sends the setting of the move, then asks for it.
void PolledManipulator::sendSetting() {
  setting_.clear();
  if (progress_.setting_sent) return request(Kind::kReadBack, settingQuery(progress_.setting));
  request(Kind::kSetting, progress_.setting);
}

void PolledManipulator::sendMove() {
  const std::string line = std::exchange(progress_.move, "");
  origin_monitor_.setMove(move_->to);
  progress_.from = move_->from;
  progress_.sent = time();
  move_->begin = time() + static_cast<double>(line.size() + 1) * common_.byteTime();
  progress_.end = move_->begin + move_->duration;
  progress_.overdue = activeTime() + 1.25 * move_->duration + kMoveAllowance;
  request(Kind::kMove, line);
  extrapolateFor(move_->begin - time() + extrapolationTime());
}

void PolledManipulator::nextOfMove() {
  if (!progress_.setting.empty()) return sendSetting();
  if (!progress_.move.empty()) return sendMove();
  if (isOutdated()) return stopFirst();
  if (!dialect_.motion.empty() && !motion_requested_) return request(Kind::kMotion, dialect_.motion);
  request(Kind::kPosition, dialect_.position);
}

/// A whole-count position near `share` of the path to the goal, and nearer to the line than others
/// down to half as far. The line starts at the first part's start, so that rounding errors do not
/// add up.
Eigen::Vector3d PolledManipulator::pointOnPath(const Eigen::Vector3d& from, double share) const {
  const Eigen::Vector3d line = (line_->goal - line_->begin).normalized();
  const Eigen::Vector3d start = line_->begin + line * line.dot(from - line_->begin), displacement = line_->goal - start;
  Eigen::Vector3d best = from;
  double least = std::numeric_limits<double>::infinity();
  for (double part = share; part > 0.5 * share; part -= 0.1 * share) {
    const Eigen::Vector3d position = (start + displacement * part).array().round(), travelled = position - start;
    const double deviation = (travelled - line * travelled.dot(line)).norm();
    if ((position - from).isZero(kSame) || deviation >= least) continue;
    best = position;
    least = deviation;
  }
  return best;
}

/// Moves to the goal, or as far as the device stays on the line and within the wanted speed. Slower
/// paths are travelled in steps with pauses. Where the speed of an axis is rounded, a new part
/// starts before the line is left.
void PolledManipulator::nextTowardsGoal() {
  const Eigen::Vector3d from = *position_, goal_position = goalPosition(), displacement = goal_position - from;
  if (goal_position.cwiseAbs().maxCoeff() > 2e9) return raiseFault("the goal exceeds the range of the protocol");
  const Eigen::Vector3d fastest = common_.axes.inDeviceOrder(speedLimits());
  const double wanted = std::min(requestedSpeed(displacement), fastestAlong(displacement));
  Plan chosen = plan(from, goal_position, wanted, fastest);
  if (!line_ || goal()->follows || line_->goal != goal_position || !isAt(from, line_->next)) {
    line_ = Line{from, goal_position, from};
  }
  const bool in_steps = chosen.speed > 1.01 * wanted;
  double part = 1 / std::max(1.0, chosen.deviation);
  if (in_steps) part = std::min(part, std::max(wanted * common_.segment_time, 2 * count()) / length(displacement));
  if (goal()->follows) part = std::min(part, 2 * common_.segment_time * wanted / length(displacement));
  Eigen::Vector3d to = goal_position;
  for (int i = 0; i < kShorter && part < 1; ++i) {
    to = pointOnPath(from, part);
    if (isAt(from, to)) to = goal_position;
    chosen = plan(from, to, wanted, fastest);
    if (chosen.deviation <= 1) break;
    part /= chosen.deviation;
  }
  line_->next = to;
  line_margin_ = std::min(reading_margin_, kStraight + 2 * count() + kExtrapolatedMotion * chosen.speed);
  const double not_sent = std::numeric_limits<double>::infinity();
  move_ = Move{from, to, goal_position, goal()->follows, not_sent, chosen.duration};
  progress_ = Progress{};
  progress_.setting = chosen.setting == setting_ ? "" : chosen.setting;
  progress_.move = chosen.move;
  progress_.speed = chosen.speed;
  if (in_steps) progress_.next = time() + length(to - from) / wanted;
  nextOfMove();
}

/// Handles a reading during a move: it continues, has arrived, or has missed its goal.
void PolledManipulator::checkMove(const Eigen::Vector3d& position) {
  const bool there = isAt(position, move_->to);
  const bool reports_rest = dialect_.motion.empty() || progress_.at_rest_since;
  progress_.at_goal = there && reports_rest ? progress_.at_goal + 1 : 0;
  // A device that does not report rest may still move the last count, so its move ends after its
  // duration.
  const bool at_rest = dialect_.motion.empty()
                           ? progress_.at_goal > 0 && time() >= progress_.end
                           : progress_.at_goal >= kSteady || (progress_.at_goal > 0 && timeLeft() <= 0);
  if (at_rest && position.isZero(kSame) && !progress_.zero_checked && !confirmed_.empty()) {
    lost_setting_replies_ = 0;
    // A device that was switched off just before its goal also reads 0 at rest there.
    progress_.zero_checked = check_setting_ = true;
    return;
  }
  if (at_rest) {
    next_move_ = progress_.next;
    tries_ = overdue_ = too_fast_ = 0;
    return rest(position);
  }
  const bool rests_elsewhere = progress_.at_rest_since && activeTime() > *progress_.at_rest_since + kSettleTime;
  if (activeTime() > progress_.overdue || rests_elsewhere) return handleMissedGoal(position);
  // The reading was taken half its transmission time ago.
  const double then = time() - 0.5 * dialect_.longest_reading * common_.byteTime();
  const double whole = (move_->to - move_->from).norm(), left = (move_->to - position).norm();
  if (whole > 0 && then > move_->begin) {
    move_->duration *= std::min(1.0, left / whole);
    move_->from = position;
    move_->begin = then;
  }
}

/// Whether a reading on the way is further along it than the device can have come since the move was sent. The time of
/// receipt is an upper bound of that of the reading, and the whole move is compared: a program that stood still reads
/// late, but never too far. A reading beside the way is judged elsewhere.
bool PolledManipulator::isTooFar(const Eigen::Vector3d& position) const {
  if (!isUnderWay() || besideTheLine(position) > line_margin_) return false;
  const Eigen::Vector3d way = (move_->to - progress_.from).normalized();
  const double along = (position - progress_.from).dot(way) * count();
  const double margin = std::min(reading_margin_, kStraight + 2 * count());
  return along > kFaster * progress_.speed * (time() - progress_.sent) + margin;
}

/// Stops a move that is too fast. Where the device is by now is not known before it rests.
void PolledManipulator::handleTooFast() {
  if (++too_fast_ >= kTries) {
    too_fast_ = 0;
    return raiseFault(
        "it moves faster than it was told, or its replies are changed on the line; check cable and port, then enable");
  }
  forgetPosition();
  stopUnheard();
}

/// Handles a move that ended before its goal. A device is hardly ever stopped exactly at 0. A
/// device that was switched off there, or close enough to seem on its path, reads 0.
void PolledManipulator::handleMissedGoal(const Eigen::Vector3d& position) {
  if (detectNewOrigin(position, 0, position.isZero(kSame) && !origin_monitor_.mayStandAt(position, counts(), 0), 0))
    return;
  position_ = position;
  move_.reset();
  if (++tries_ < kTries) return stopFirst();
  const std::string reason = notArrivedReason();
  raiseFault(kNotArrived + (reason.empty() ? "it was interrupted" : reason));
}

}  // namespace microinjection
