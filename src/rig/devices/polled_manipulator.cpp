#include "rig/devices/polled_manipulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

constexpr double kLongestGuess = 0.1;  // s, of motion by which a position that is carried on may be off
constexpr double kHeldAnswer = 0.02;   // s, for which a USB adapter may hold an answer back
constexpr int kSetupTries = 6;         // of a line at the begin, which must be answered twice alike
constexpr std::size_t kLongestLine = 80;

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
                  std::max(config.answer_time, kHeldAnswer) + dialect.stop_duration + 20 * config.byteTime() + 5e-3,
                  config.reply_timeout + dialect.longest_move * config.byteTime(), dialect.farewell},
                 dialect.longest_move),
      reading_margin_(config.reading_margin),
      dialect_(dialect),
      lines_("\r", kLongestLine) {}

ManipulatorAbilities PolledManipulator::abilities() const {
  const double reading = dialect_.longest_reading * common_.byteTime() + answer_time_;
  const double turn =
      dialect_.longest_move * common_.byteTime() + 2 * answer_time_ + common_.segment_time + 2 * reading;
  ManipulatorAbilities abilities = abilitiesWith(turn);
  abilities.device = dialect_.device;
  abilities.stop_time += dialect_.stop_duration;
  return abilities;
}

/// Silence after an exchange that went wrong, what a new session says, and as much as a turn to spare.
double PolledManipulator::recoveryTime() const {
  constexpr int kLineAndAnswer = 20, kReadings = 4;  // bytes of a line at the begin; readings until it stands
  int lines = 2;
  for (int i = 0; !setup(i).empty(); ++i) lines += 2;
  return common_.reply_timeout + dialect_.longest_move * common_.byteTime() + dialect_.stop_duration +
         lines * (kLineAndAnswer * common_.byteTime() + answer_time_) +
         kReadings * (dialect_.longest_reading * common_.byteTime() + answer_time_) + abilities().reading_interval;
}

void PolledManipulator::begin(bool lost) {
  MoveByMove::begin(lost);
  exchange_.reset();
  lines_.clear(false);
  stop_requested_ = asked_motion_ = false;
  ask_kept_ = lost && !confirmed_.empty();
  not_kept_ = 0;
  if (lost) forgetSettings();
}

/// Whatever was set in the device may be lost.
void PolledManipulator::forgetSettings() {
  setup_step_ = setup_tries_ = 0;
  setup_answer_.reset();
  setting_.clear();
}

void PolledManipulator::onStopSent() {
  MoveByMove::onStopSent();
  next_move_ = 0;
}

void PolledManipulator::exchange(const std::string& bytes) {
  for (const std::string& line : lines_.feed(bytes)) {
    const std::string answer = !line.empty() && line[0] == '\n' ? line.substr(1) : line;
    handle(answer);
    if (!exchanging()) return;
  }
  if (exchange_ && listened() > exchange_->due) return lostStep("no answer to \"" + exchange_->line + "\"");
  if (!exchange_) next();
}

void PolledManipulator::notUnderstood(const std::string& answer) {
  ++malformed_;
  lostStep(exchange_ ? "answers \"" + printable(answer) + "\" to \"" + exchange_->line + "\""
                     : "says \"" + printable(answer) + "\" without being asked");
}

void PolledManipulator::handle(const std::string& answer) {
  if (!exchange_) return notUnderstood(answer);
  measure(exchange_->sent, answer.size() + 1);
  switch (exchange_->kind) {
    case Kind::kSetup:
      return takeSetupAnswer(answer);
    case Kind::kPosition:
      return takePosition(answer);
    case Kind::kMotion:
      return takeMotion(answer);
    case Kind::kKept:
      understood();
      exchange_.reset();
      if (!isKept(confirmed_, answer)) return takeNotKept();
      ask_kept_ = false;
      return;
    case Kind::kStop:
    case Kind::kMove:
      if (!acknowledges(exchange_->line, answer)) return notUnderstood(answer);
      understood();
      if (exchange_->kind == Kind::kStop) stop_requested_ = true;
      if (exchange_->line == setting_) confirmed_ = setting_;
      if (exchange_->kind == Kind::kMove && progress_.move.empty()) watch_.hasDeparted();
      exchange_.reset();
  }
}

void PolledManipulator::takeSetupAnswer(const std::string& answer) {
  const bool twice = setup_answer_ == answer;
  if (!twice && ++setup_tries_ > kSetupTries) return notUnderstood(answer);
  if (!twice && setup_answer_) ++malformed_;
  exchange_.reset();
  setup_answer_ = answer;
  if (!twice) return;
  setup_answer_.reset();
  setup_tries_ = 0;
  const std::string line = setup(setup_step_), refusal = takeSetup(setup_step_++, answer);
  if (!refusal.empty()) return raiseFault("answers \"" + printable(answer) + "\" to \"" + line + "\": " + refusal);
  if (setup(setup_step_).empty()) confirmed_ = line;  // what is asked before sets nothing
  understood();
}

/// Said twice: the answer may be a damaged one.
void PolledManipulator::takeNotKept() {
  if (++not_kept_ < 2) return;
  ask_kept_ = false;
  settings_lost_ = true;
}

void PolledManipulator::takeMotion(const std::string& answer) {
  const std::optional<bool> moves = readMotion(answer);
  if (!moves) return notUnderstood(answer);
  exchange_.reset();
  understood();
  asked_motion_ = true;
  if (!move_) return;
  if (*moves) {
    progress_.stood.reset();
  } else if (!progress_.stood) {
    progress_.stood = listened();
  }
}

void PolledManipulator::takePosition(const std::string& answer) {
  const std::optional<Eigen::Vector3d> place = readPosition(answer);
  if (!place) return notUnderstood(answer);
  exchange_.reset();
  asked_motion_ = false;
  understood();
  takePlace(*place);
}

void PolledManipulator::takePlace(const Eigen::Vector3d& place) {
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  const Eigen::Vector3d expected = position_ && settled_ ? extrapolatedPosition(time()) : nowhere;
  const double speed = move_ ? (move_->to - move_->from).norm() / std::max(move_->duration, 1e-3) : 0;  // counts/s
  const double under_way = reading_margin_ / count() + kLongestGuess * speed;
  // At rest, and until it is known to be, only what is told four times can be another place than before.
  const double tolerance = move_ ? under_way : kSame;
  if (!filter_.accept(place, expected, tolerance, tolerance) || !answers_.measured()) return;  // asked again
  const bool elsewhere = !((place - expected).cwiseAbs().maxCoeff() <= tolerance);
  const bool jumped = move_ && elsewhere && place.isZero(kSame);
  const bool new_zero = jumped || ((!move_ || settings_lost_) && isNewZero(place, reading_margin_));
  const bool by_hand = dialect_.moved_by_hand && settled_ && !move_;
  if (beginsAnew(place, by_hand ? 0 : watch_.outside(place, counts()), new_zero, reading_margin_)) return;
  if (move_) return checkMove(place);
  if (settled_) {
    corrected(place, expected);
    if (elsewhere) forgetSettings();
    return rest(place);
  }
  settled_ = true;
  rest(place);
  known();
}

void PolledManipulator::ask(Kind kind, const std::string& line) {
  const double sent = listened() + static_cast<double>(line.size() + 1) * common_.byteTime();
  const double wire = static_cast<double>(std::max(dialect_.longest_reading, line.size())) * common_.byteTime();
  const bool may_stop = kind == Kind::kKept || kind == Kind::kStop || kind == Kind::kSetup;
  const double more = may_stop ? dialect_.stop_duration : 0;
  exchange_ = Exchange{kind, line, sent + wire + common_.reply_timeout + more, sent};
  if (settled_ && !filter_.isImplausible()) validityTime(exchange_->due - listened() + recoveryTime());
  say(line + "\r");
}

void PolledManipulator::next() {
  if (ask_kept_) return ask(Kind::kKept, askKept(confirmed_));
  if (const std::string line = setup(setup_step_); !line.empty()) return ask(Kind::kSetup, line);
  if (!stop_requested_) return ask(Kind::kStop, dialect_.stop);
  if (!settled_ || filter_.isImplausible()) return ask(Kind::kPosition, dialect_.position);
  if (move_) return nextOfMove();
  if (goal() && mayMove() && time() >= next_move_ && !isThere(*position_, goalPlace())) {
    return nextTowardsGoal();
  }
  if (time() >= next_rest_reading_) ask(Kind::kPosition, dialect_.position);
}

}  // namespace microinjection
