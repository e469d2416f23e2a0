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
  ConfigReader line = reader.section("port", ConfigReader::kRequired);
  port = SerialPortConfig::read(line, default_baud);
  axes = AxisOrder::read(reader);
  joints = JointAxes::read(reader);
  reader.number("speed", speed, speeds);
  reader.number("segment_time", segment_time, {0.01, 1});
  reader.number("answer_time", answer_time, Range::nonNegative());
  reader.number("reply_timeout", reply_timeout, Range::positive());
  reader.number("rest_reading_interval", rest_reading_interval, {0.05, 60});
  reader.number("reading_margin", reading_margin, Range::positive());
}

PolledManipulator::PolledManipulator(const PolledManipulatorConfig& config, std::unique_ptr<Wire> wire,
                                     const Dialect& dialect)
    : SerialManipulator(std::move(wire), {dialect.short_name, dialect.guarded_stop,
                                          std::max(config.answer_time, kHeldAnswer) + dialect.stop_duration +
                                              20 * config.byteTime() + 5e-3,
                                          config.reply_timeout + dialect.longest_move * config.byteTime()}),
      common_(config),
      dialect_(dialect),
      lines_("\r", kLongestLine),
      answer_time_(config.answer_time) {}

ManipulatorAbilities PolledManipulator::abilities() const {
  ManipulatorAbilities abilities;
  abilities.device = dialect_.device;
  abilities.follows = false;
  const double reading = dialect_.longest_reading * common_.byteTime() + answer_time_;
  // A turn: a move is said, goes, and is seen to have arrived.
  const double turn =
      dialect_.longest_move * common_.byteTime() + 2 * answer_time_ + common_.segment_time + 2 * reading;
  abilities.command_interval = abilities.reading_interval = turn;
  abilities.resolution = count() * std::max(1.0, arrival());
  abilities.speed = std::min(common_.speed, speedLimits().maxCoeff());
  abilities.latency = turn + dialect_.longest_move * common_.byteTime() + answer_time_;
  abilities.stop_time =
      dialect_.guarded_stop.size() * common_.byteTime() + common_.answer_time + dialect_.stop_duration;
  return abilities;
}

/// Silence after an exchange that went wrong, what a new session says, and as much as a turn to spare.
double PolledManipulator::recoveryTime() const {
  constexpr int kLineAndAnswer = 20, kReadings = 4;  // bytes of a line at the begin; readings until it stands
  int lines = 1;
  for (int i = 0; !setup(i).empty(); ++i) lines += 2;
  return common_.reply_timeout + dialect_.longest_move * common_.byteTime() + dialect_.stop_duration +
         lines * (kLineAndAnswer * common_.byteTime() + answer_time_) +
         kReadings * (dialect_.longest_reading * common_.byteTime() + answer_time_) + abilities().reading_interval;
}

Eigen::Vector3d PolledManipulator::carriedOn(double at) const {
  if (!move_) return *position_;
  const double gone = std::max(0.0, at - move_->begin);
  if (gone >= move_->duration) return move_->to;
  return move_->from + (move_->to - move_->from) * (gone / move_->duration);
}

std::optional<ManipulatorDevice::Reading> PolledManipulator::reading() const {
  if (!position_ || !sure()) return std::nullopt;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (timeLeft() > 0 && time() > move_->begin) velocity = (move_->to - move_->from) * (count() / move_->duration);
  return Reading{common_.joints.toJoints(common_.axes.inJointOrder(carriedOn(time()) * count())),
                 common_.joints.directions.cwiseProduct(common_.axes.inJointOrder(velocity))};
}

Eigen::Vector3d PolledManipulator::goalPlace() const {
  const Eigen::Vector3d device = common_.axes.inDeviceOrder(common_.joints.toDevice(goal()->joints));
  return (device / count()).array().round();
}

bool PolledManipulator::isThere(const Eigen::Vector3d& place, const Eigen::Vector3d& goal) const {
  return (place - goal).cwiseAbs().maxCoeff() <= arrival();
}

bool PolledManipulator::moving() const {
  if (!goal()) return !settled_;
  return move_ || !settled_ || !position_ || !isThere(*position_, goalPlace());
}

void PolledManipulator::begin(bool lost) {
  exchange_.reset();
  filter_.forget();
  lines_.clear(false);
  asked_stop_ = settled_ = asked_motion_ = false;
  lost_session_ = lost;
  begun_anew_ = begun_anew_ && !clearing();
  if (!lost) return;
  setup_step_ = setup_tries_ = 0;
  setup_answer_.reset();
  sessionLost();
}

void PolledManipulator::stopSaid() {
  if (position_) position_ = carriedOn(time() + dialect_.guarded_stop.size() * common_.byteTime());
  move_.reset();
  settled_ = false;
  next_move_ = 0;
  trustAtMost(common_.reply_timeout + dialect_.longest_move * common_.byteTime() + recoveryTime());
}

void PolledManipulator::talk(const std::string& bytes) {
  for (const std::string& line : lines_.feed(bytes)) {
    const std::string answer = !line.empty() && line[0] == '\n' ? line.substr(1) : line;
    handle(answer);
    if (!talking()) return;
  }
  if (exchange_ && listened() > exchange_->due) return lostStep("no answer to \"" + exchange_->line + "\"");
  if (!exchange_) next();
}

void PolledManipulator::malformed(const std::string& answer) {
  ++malformed_;
  lostStep(exchange_ ? "answers \"" + printable(answer) + "\" to \"" + exchange_->line + "\""
                     : "says \"" + printable(answer) + "\" without being asked");
}

/// A slow adapter makes every turn longer; who commands the rig is told of it by its abilities.
void PolledManipulator::measure(const std::string& answer) {
  answers_.add(listened() - exchange_->sent - static_cast<double>(answer.size() + 1) * common_.byteTime());
  answer_time_ = std::max(common_.answer_time, answers_.measured().value_or(0));
}

void PolledManipulator::handle(const std::string& answer) {
  if (!exchange_) return malformed(answer);
  if (!answers_.measured()) measure(answer);
  switch (exchange_->kind) {
    case Kind::kSetup:
      return takeSetupAnswer(answer);
    case Kind::kPosition:
      return takePosition(answer);
    case Kind::kMotion:
      return takeMotion(answer);
    case Kind::kStop:
    case Kind::kMove:
      if (!acknowledges(exchange_->line, answer)) return malformed(answer);
      understood();
      if (exchange_->kind == Kind::kStop) asked_stop_ = true;
      exchange_.reset();
  }
}

void PolledManipulator::takeSetupAnswer(const std::string& answer) {
  const bool twice = setup_answer_ == answer;
  if (!twice && ++setup_tries_ > kSetupTries) return malformed(answer);
  if (!twice && setup_answer_) ++malformed_;
  exchange_.reset();
  setup_answer_ = answer;
  if (!twice) return;
  setup_answer_.reset();
  setup_tries_ = 0;
  const std::string line = setup(setup_step_), refusal = takeSetup(setup_step_++, answer);
  if (!refusal.empty()) return raiseFault("answers \"" + printable(answer) + "\" to \"" + line + "\": " + refusal);
  understood();
}

void PolledManipulator::takeMotion(const std::string& answer) {
  const std::optional<bool> moves = readMotion(answer);
  if (!moves) return malformed(answer);
  exchange_.reset();
  understood();
  asked_motion_ = true;
  if (!move_) return;
  if (*moves) {
    move_->stood.reset();
  } else if (!move_->stood) {
    move_->stood = listened();
  }
}

void PolledManipulator::takePosition(const std::string& answer) {
  const std::optional<Eigen::Vector3d> place = readPosition(answer);
  if (!place) return malformed(answer);
  exchange_.reset();
  asked_motion_ = false;
  understood();
  takePlace(*place);
}

/// Whether the device stands elsewhere than it did, although nobody can have moved it.
bool PolledManipulator::beginsAnew(const Eigen::Vector3d& place) {
  std::optional<Eigen::Vector3d> before;
  if (settled_ && !dialect_.moved_by_hand) before = position_;
  if (!settled_ && lost_session_) before = rested_;
  if (begun_anew_) return true;
  if (!before || clearing()) return false;
  const double way = (place - *before).norm() * count();
  if (way <= common_.reading_margin) return false;
  rested_.reset();
  position_.reset();
  begun_anew_ = true;  // and so no position is told
  raiseFault("it stood, and now tells a place " + std::to_string(std::lround(way * 1e6)) +
             " um from there: if it was switched off its coordinates began anew; check them, then enable");
  return true;
}

void PolledManipulator::takePlace(const Eigen::Vector3d& place) {
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  const Eigen::Vector3d expected = position_ && settled_ ? carriedOn(time()) : nowhere;
  const double speed = move_ ? (move_->to - move_->from).norm() / std::max(move_->duration, 1e-3) : 0;  // counts/s
  const double under_way = common_.reading_margin / count() + kLongestGuess * speed;
  // At rest, and until it is known to be, only what is told four times can be another place than before.
  const double tolerance = move_ ? under_way : kSame;
  if (!filter_.accept(place, expected, tolerance, tolerance) || !answers_.measured()) return;  // asked again
  if (move_) return checkMove(place);
  if (beginsAnew(place)) return;
  if (settled_) {
    largest_correction_ = std::max(largest_correction_, (place - expected).cwiseAbs().maxCoeff() * count());
    return rest(place);
  }
  settled_ = true;
  rest(place);
  known();
}

/// It stands there, until it is asked again.
void PolledManipulator::rest(const Eigen::Vector3d& place) {
  position_ = rested_ = place;
  next_rest_reading_ = time() + common_.rest_reading_interval;
  trustFor(std::numeric_limits<double>::infinity());
}

void PolledManipulator::ask(Kind kind, const std::string& line) {
  const double sent = listened() + static_cast<double>(line.size() + 1) * common_.byteTime();
  const double wire = static_cast<double>(std::max(dialect_.longest_reading, line.size())) * common_.byteTime();
  const double more = kind == Kind::kStop || kind == Kind::kSetup ? dialect_.stop_duration : 0;
  exchange_ = Exchange{kind, line, sent + wire + common_.reply_timeout + more, sent};
  if (settled_ && !filter_.doubts()) trustFor(exchange_->due - listened() + recoveryTime());
  say(line + "\r");
}

void PolledManipulator::next() {
  if (const std::string line = setup(setup_step_); !line.empty()) return ask(Kind::kSetup, line);
  if (!asked_stop_) return ask(Kind::kStop, dialect_.stop);
  if (!settled_ || filter_.doubts()) return ask(Kind::kPosition, dialect_.position);
  if (move_) return nextOfMove();
  if (goal() && mayMove() && time() >= next_move_ && !isThere(*position_, goalPlace())) {
    return nextTowardsGoal();
  }
  if (time() >= next_rest_reading_) ask(Kind::kPosition, dialect_.position);
}

}  // namespace microinjection
