#include "rig/devices/mp285/mp285_driver.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kFineLimit = 1310;     // um/s
constexpr double kHeldAnswer = 0.02;    // s, for which a USB adapter may hold an answer back
constexpr double kBytePause = 0.04;     // s, longest between two bytes of an answer (USB adapters collect for 16 ms)
constexpr double kMoveAllowance = 0.5;  // s, that a move may take longer than its way at its speed, and a quarter
constexpr double kCoarseStep = 5;       // microsteps, of a coarse move's end
constexpr double kMargin = 5e-6;        // m, from the ends of a move at which it may still be on its way
constexpr int kSlowest = 20;            // um/s, of a short move
constexpr int kTries = 2;               // of a move that ends elsewhere
constexpr std::size_t kMoveBytes = 19;  // what a move takes: with now and then a speed before it, and both answers

}  // namespace

Mp285Driver::Mp285Driver(const Mp285Config& config, std::unique_ptr<Wire> wire)
    : MoveByMove(config, std::move(wire),
                 {"MP-285", std::string(1, kMp285Stop),
                  std::max(config.answer_time, kHeldAnswer) + 6 * config.byteTime() + 5e-3,
                  config.half_command_time + 14 * config.byteTime()},
                 kMoveBytes),
      config_(config) {}

ManipulatorAbilities Mp285Driver::abilities() const {
  // A turn: move (14 bytes) and its end (1), position asked (2) and told (13), now and then a speed (4 and 1).
  const double turn = 35 * config_.byteTime() + 3 * (answer_time_ + config_.command_pause) + config_.segment_time;
  ManipulatorAbilities abilities = abilitiesWith(turn);
  abilities.device = "Sutter MP-285";
  return abilities;
}

/// Silence after an exchange that went wrong, the questions of a new session, an answer that is cut off, and as much as
/// a turn to spare.
double Mp285Driver::recoveryTime() const {
  return config_.half_command_time + kBytePause + 105 * config_.byteTime() +
         5 * (answer_time_ + config_.command_pause) + abilities().reading_interval;
}

void Mp285Driver::begin(bool lost) {
  MoveByMove::begin(lost);
  exchange_.reset();
  stop_requested_ = false;
  reading_due_ = true;
  if (!lost) return;
  status_requested_ = false;
  told_status_.reset();
  forgetSettings();
}

/// Whatever was set in the device may be lost.
void Mp285Driver::forgetSettings() {
  absolute_ = false;
  speed_.reset();
}

void Mp285Driver::exchange(const std::string& bytes) {
  if (!bytes.empty()) last_byte_ = listened();
  if (exchange_) {
    const bool silent = parser_.begun() && listened() - last_byte_ > kBytePause;
    if (const auto answer = parser_.feed(bytes, silent)) {
      handle(*answer);
    } else if (listened() > exchange_->due) {
      lostStep("no answer, or half of one");
    } else if (exchange_->kind == Kind::kMove && isOutdated()) {
      stopFirst();
    }
  } else if (!bytes.empty()) {
    ++malformed_;  // nobody asked: what is under way cannot be told from an answer any more
    return lostStep("it talks without being asked");
  }
  if (exchanging() && !exchange_ && listened() >= next_command_) next();
}

void Mp285Driver::ask(Kind kind, const std::string& bytes, double more_time) {
  using Expected = Mp285Parser::Expected;
  parser_.expect(kind == Kind::kPosition ? Expected::kPosition
                 : kind == Kind::kStatus ? Expected::kStatus
                 : kind == Kind::kStop   ? Expected::kStop
                                         : Expected::kDone);
  const double answer_bytes = kind == Kind::kStatus ? 33 : 13;
  const double sent = listened() + static_cast<double>(bytes.size()) * config_.byteTime();
  exchange_ = Exchange{kind, sent + answer_bytes * config_.byteTime() + config_.reply_timeout + more_time, sent};
  // It says nothing while it moves, nor unasked at rest: what it was asked last must be answered, or else, once, what
  // it is asked after that. Readings that are doubted are asked for again, but not valid for longer.
  if (settled_ && !filter_.isImplausible()) validityTime(exchange_->due - listened() + recoveryTime());
  say(bytes);
}

void Mp285Driver::handle(const Mp285Answer& answer) {
  using Answer = Mp285Answer::Kind;
  const Kind kind = exchange_->kind;
  const bool late = kind == Kind::kMove;  // answered at its end
  if (!late && answer.kind != Answer::kError && answer.kind != Answer::kMalformed) {
    measure(exchange_->sent, kind == Kind::kPosition ? 13 : kind == Kind::kStatus ? 33 : 1);
  }
  exchange_.reset();
  next_command_ = listened() + config_.command_pause;
  if (answer.kind == Answer::kError) return handleError(answer.error);
  const bool fits = answer.kind == (kind == Kind::kPosition ? Answer::kPosition
                                    : kind == Kind::kStatus ? Answer::kStatus
                                                            : Answer::kDone) ||
                    (answer.kind == Answer::kStopped && kind == Kind::kStop);
  if (!fits) {
    ++malformed_;
    return lostStep("an answer that is none");
  }
  understood();
  switch (kind) {
    case Kind::kStop:
      stop_requested_ = true;
      break;
    case Kind::kStatus:
      takeStatus(answer.status);
      break;
    case Kind::kAbsolute:
      absolute_ = true;
      break;
    case Kind::kPosition:
      takePosition(answer.position);
      break;
    case Kind::kVelocity:
      confirmed_ = speed_;
      break;
    case Kind::kMove:
      reading_due_ = true;
      break;
  }
}

/// What a microstep is. Garbled, it would make every position wrong: it counts when it is said twice. A size that is
/// not known moves nothing.
void Mp285Driver::takeStatus(const Mp285Status& status) {
  const bool twice = told_status_ && told_status_->step_div == status.step_div &&
                     told_status_->step_mul == status.step_mul && told_status_->speed == status.speed &&
                     told_status_->fine == status.fine;
  told_status_ = status;
  if (!twice) return;
  const std::optional<double> known = mp285Microstep(status.step_div, status.step_mul);
  if (!known && config_.microsteps.minCoeff() == 0) {
    return raiseFault("STEP_DIV = " + std::to_string(status.step_div) +
                      " and STEP_MUL = " + std::to_string(status.step_mul) + " of its status (" + status.bytes +
                      ") are no known size of a microstep; measure it and set microsteps");
  }
  status_requested_ = true;
  if (confirmed_ && !(*confirmed_ == Speed{status.speed, status.fine})) settings_lost_ = true;
  nominal_microstep_ = known.value_or(config_.microsteps.minCoeff());
  Eigen::Vector3d microsteps;
  for (int i = 0; i < 3; ++i) microsteps[i] = config_.microsteps[i] > 0 ? config_.microsteps[i] : *known;
  if (microsteps != microsteps_) {
    position_.reset();
    watch_.clear();
  }
  microsteps_ = microsteps;
}

void Mp285Driver::handleError(int error) {
  if (error == 8 && move_) {
    position_ = extrapolatedPosition(time());
    reading_due_ = true;  // how far did it come?
    return;
  }
  lostStep(mp285ErrorName(error));
}

void Mp285Driver::takePosition(const Mp285Position& told) {
  const Eigen::Vector3d place(told[0], told[1], told[2]);
  const Eigen::Vector3d expected = position_ ? extrapolatedPosition(time()) : Eigen::Vector3d::Constant(std::nan(""));
  // What stands does not change by a microstep, and a fine move ends where it was sent: else four must agree.
  const double tolerance = move_ && coarse_ ? kCoarseStep + 1 : 0.5;
  if (!filter_.accept(place, expected, tolerance, 0.5) || !answers_.measured()) return;  // asked again
  const bool elsewhere = !((place - expected).cwiseAbs().maxCoeff() <= tolerance);
  const double outside = move_ ? watch_.outside(place, counts()) : 0;
  if (beginsAnew(place, outside, isNewZero(place, kMargin), kMargin)) return;
  if (position_ && settled_) corrected(place, expected);
  if (settled_ && !move_ && elsewhere) forgetSettings();
  const bool missed = move_ && (place - move_->to).cwiseAbs().maxCoeff() > tolerance;
  rest(place);
  reading_due_ = false;
  if (!settled_) {
    settled_ = true;
    known();
  }
  if (!missed) {
    tries_ = 0;
  } else if (++tries_ >= kTries) {
    raiseFault("the move does not arrive: it was interrupted");
  }
}

void Mp285Driver::next() {
  if (!stop_requested_) return ask(Kind::kStop, std::string(1, kMp285Stop));
  if (!status_requested_) return ask(Kind::kStatus, mp285AskStatus());
  if (!absolute_) return ask(Kind::kAbsolute, mp285AbsoluteMode());
  if (reading_due_) return ask(Kind::kPosition, mp285AskPosition());
  if (goal() && mayMove() && !isThere(*position_, goalPlace())) return nextTowardsGoal();
  if (config_.rest_reading_interval > 0 && time() >= next_rest_reading_) reading_due_ = true;
}

/// What the device takes for a metre along a way (microsteps) is so long: an axis may have a microstep of its own.
double Mp285Driver::metresPerSaidMetre(const Eigen::Vector3d& way) const {
  return length(way) / (way.norm() * nominal_microstep_);
}

Mp285Driver::Speed Mp285Driver::speedFor(const Eigen::Vector3d& full_path) const {
  const double way = full_path.norm();
  const double per_said = metresPerSaidMetre(full_path);
  int um_per_s = static_cast<int>(std::lround(std::min(askedSpeed(full_path), config_.speed) / per_said * 1e6));
  um_per_s = std::max(um_per_s, goal()->follows ? kSlowest : 1);
  int fastest = std::max(1, static_cast<int>(fastestAlong(full_path) / per_said * 1e6 + 1e-6));  // as it is said
  const bool fine =
      std::min(um_per_s, fastest) <= kFineLimit || way < 10 * kCoarseStep;  // the rest of a coarse move is a fine one
  if (fine) fastest = std::min(fastest, static_cast<int>(kFineLimit));
  um_per_s = std::min(um_per_s, fastest);
  // A speed that is about right is kept: to set it takes as long as a third of a move's exchange.
  if (goal()->follows && speed_ && speed_->fine == fine && speed_->um_per_s >= 0.9 * um_per_s &&
      speed_->um_per_s <= std::min<double>(1.5 * um_per_s, fastest)) {
    return *speed_;
  }
  return {um_per_s, fine};
}

void Mp285Driver::nextTowardsGoal() {
  const Eigen::Vector3d goal_place = goalPlace(), way = goal_place - *position_;
  const Speed speed = speedFor(way);
  if (!speed_ || !(*speed_ == speed)) {
    confirmed_.reset();
    speed_ = speed;  // if this fails, the session that follows forgets it
    return ask(Kind::kVelocity, mp285SetVelocity(speed.um_per_s, speed.fine));
  }
  const double rate = speed.um_per_s * 1e-6 / nominal_microstep_;  // microsteps/s
  Move move{*position_, goal_place, goal_place, goal()->follows, 0, 0};
  const double longest = rate * 2 * config_.segment_time;
  if (move.follows && way.norm() > longest) move.to = (move.from + way.normalized() * longest).array().round();
  move.duration = (move.to - move.from).norm() / rate;
  Mp285Position place;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(move.to[i]) > 2e9) return raiseFault("the goal is too far away to be said");
    place[i] = static_cast<std::int32_t>(move.to[i]);
  }
  move.begin = time() + 14 * config_.byteTime();
  move_ = move;
  coarse_ = !speed.fine;
  watch_.goesTo(move.to);
  ask(Kind::kMove, mp285Move(place), 1.25 * timeLeft() + kMoveAllowance);
}

}  // namespace microinjection
