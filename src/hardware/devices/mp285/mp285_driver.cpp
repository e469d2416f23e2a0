#include "hardware/devices/mp285/mp285_driver.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kFineLimit = 1310;    // um/s
constexpr double kBytePause = 0.04;    // s, longest pause between two bytes of a reply (USB adapters collect for 16 ms)
constexpr double kCoarseStep = 5;      // microsteps, resolution of a coarse move
constexpr double kLongestPart = 1.5;   // segment_time, duration of a part of the way; 2 towards a set-point
constexpr double kMargin = 5e-6;       // m, from the ends of a move within which it may still be moving
constexpr int kSlowestShortMove = 20;  // um/s, of a short move
constexpr int kReadingBytes = 15;      // a request of the position and its reply
constexpr std::size_t kMoveBytes = 19;  // for a move, sometimes with a speed, including replies

}  // namespace

Mp285Config Mp285Config::read(ConfigReader& reader) {
  Mp285Config config;
  config.readCommon(reader, 9600, {1e-6, 6.55e-3}, Range::nonNegative());
  reader.vector("microsteps", config.microsteps, Range::closed(0, 1e-6));
  if (((config.microsteps.array() > 0) && (config.microsteps.array() < 1e-9)).any()) {
    reader.error("microsteps", "each must be 0 (by the device's status) or from 1e-9 to 1e-6 m");
  }
  reader.number("move_allowance", config.move_allowance, Range::closed(0.02, 2));
  reader.number("command_pause", config.command_pause, Range::nonNegative());
  reader.number("half_command_time", config.half_command_time, Range::positive());
  return config;
}

Mp285Driver::Mp285Driver(const Mp285Config& config, std::unique_ptr<Wire> wire)
    : MoveByMove(config, std::move(wire),
                 {"MP-285", std::string(1, kMp285Stop),
                  config.answer_time + kHeldReply + kReadingBytes * config.byteTime() + 5e-3,
                  config.half_command_time + 14 * config.byteTime()},
                 kMoveBytes),
      config_(config) {}

ManipulatorAbilities Mp285Driver::abilities() const {
  // A turn: move (14 bytes) and its reply (1), position request (2) and reply (13), sometimes a
  // speed (4 and 1).
  const double turn = 35 * config_.byteTime() + 3 * (answer_time_ + config_.command_pause) + config_.segment_time;
  ManipulatorAbilities abilities = abilitiesWith(turn);
  abilities.device = "Sutter MP-285";
  abilities.reading_interval += config_.segment_time;  // the longest move towards a set-point takes two of them
  return abilities;
}

/// Silence after a failed exchange, the requests of a new session, an incomplete reply, and one
/// turn as reserve.
double Mp285Driver::recoveryTime() const {
  return config_.half_command_time + kBytePause + 105 * config_.byteTime() +
         5 * (answer_time_ + config_.command_pause) + abilities().command_interval;
}

void Mp285Driver::begin(bool lost) {
  MoveByMove::begin(lost);
  exchange_.reset();
  stop_requested_ = false;
  reading_due_ = true;
  if (!lost) return;
  status_requested_ = false;
  last_status_.reset();
  forgetSettings();
}

/// The device may have lost its settings.
void Mp285Driver::forgetSettings() {
  absolute_ = false;
  speed_.reset();
}

void Mp285Driver::exchange(const std::string& bytes) {
  if (!bytes.empty()) last_byte_ = activeTime();
  if (exchange_) {
    const bool silent = parser_.begun() && activeTime() - last_byte_ > kBytePause;
    if (const auto reply = parser_.feed(bytes, silent)) {
      handle(*reply);
    } else if (activeTime() > exchange_->due) {
      exchangeFailed(exchange_->kind == Kind::kMove ? "a move has not ended in time (move_allowance)"
                                                    : "no reply, or an incomplete one");
    } else if (exchange_->kind == Kind::kMove && isOutdated()) {
      stopFirst();
    }
  } else if (!bytes.empty()) {
    ++malformed_;  // without a request, later bytes cannot be assigned to a reply
    return exchangeFailed("it sends bytes without a request");
  }
  if (exchanging() && !exchange_ && activeTime() >= next_command_) next();
}

void Mp285Driver::request(Kind kind, const std::string& bytes, double more_time) {
  using Expected = Mp285Parser::Expected;
  parser_.expect(kind == Kind::kPosition ? Expected::kPosition
                 : kind == Kind::kStatus ? Expected::kStatus
                 : kind == Kind::kStop   ? Expected::kStop
                                         : Expected::kDone);
  const double reply_bytes = kind == Kind::kStatus ? 33 : 13;
  const double sent = activeTime() + static_cast<double>(bytes.size()) * config_.byteTime();
  const bool moves = kind == Kind::kMove;
  const double reply =
      moves ? config_.byteTime() + kHeldReply + answer_time_ : reply_bytes * config_.byteTime() + config_.reply_timeout;
  exchange_ = Exchange{kind, sent + reply + more_time, sent};
  // The device sends nothing while moving or unrequested. So the last request must be answered, or
  // else, once, the one after it. Doubtful readings are repeated, but do not extend the validity.
  const double once_more = moves ? config_.reply_timeout + kMoveAllowance : 0;
  if (settled_ && !filter_.isImplausible()) validityTime(exchange_->due - activeTime() + once_more + recoveryTime());
  send(bytes);
}

void Mp285Driver::handle(const Mp285Reply& reply) {
  using Reply = Mp285Reply::Kind;
  const Kind kind = exchange_->kind;
  const bool late = kind == Kind::kMove;  // the reply comes at the end of the move
  if (!late && reply.kind != Reply::kError && reply.kind != Reply::kMalformed) {
    measure(exchange_->sent, kind == Kind::kPosition ? 13 : kind == Kind::kStatus ? 33 : 1);
  }
  exchange_.reset();
  next_command_ = activeTime() + config_.command_pause;
  if (reply.kind == Reply::kError) return handleError(reply.error);
  const bool fits = reply.kind == (kind == Kind::kPosition ? Reply::kPosition
                                   : kind == Kind::kStatus ? Reply::kStatus
                                                           : Reply::kDone) ||
                    (reply.kind == Reply::kStopped && kind == Kind::kStop);
  if (!fits) {
    ++malformed_;
    return exchangeFailed("a malformed reply");
  }
  exchangeSucceeded();
  switch (kind) {
    case Kind::kStop:
      stop_requested_ = true;
      break;
    case Kind::kStatus:
      handleStatus(reply.status);
      break;
    case Kind::kAbsolute:
      absolute_ = true;
      break;
    case Kind::kPosition:
      handlePosition(reply.position);
      break;
    case Kind::kVelocity:
      confirmed_ = speed_;
      break;
    case Kind::kMove:
      reading_due_ = true;
      extrapolateFor(2 * config_.command_pause + kReadingBytes * config_.byteTime() + kHeldReply + answer_time_);
      break;
  }
}

/// Sets the microstep. A damaged value would falsify every position, so two equal replies are
/// needed. With an unknown microstep nothing moves.
void Mp285Driver::handleStatus(const Mp285Status& status) {
  const bool twice = last_status_ && last_status_->step_div == status.step_div &&
                     last_status_->step_mul == status.step_mul && last_status_->speed == status.speed &&
                     last_status_->fine == status.fine;
  last_status_ = status;
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
    origin_monitor_.clear();
  }
  microsteps_ = microsteps;
}

void Mp285Driver::handleError(int error) {
  if (error == 8 && move_) {
    position_ = extrapolatedPosition(time());
    reading_due_ = true;  // to find how far it moved
    return;
  }
  exchangeFailed(mp285ErrorName(error));
}

void Mp285Driver::handlePosition(const Mp285Position& reading) {
  const Eigen::Vector3d position(reading[0], reading[1], reading[2]);
  const Eigen::Vector3d expected = position_ ? extrapolatedPosition(time()) : Eigen::Vector3d::Constant(std::nan(""));
  // A resting axis does not change by a microstep, and a fine move ends at its goal. Any other
  // position needs four equal readings.
  const double tolerance = move_ && coarse_ ? kCoarseStep + 1 : 0.5;
  if (!filter_.accept(position, expected, tolerance, 0.5) || !reply_times_.measured()) return;  // requested again
  const bool elsewhere = !((position - expected).cwiseAbs().maxCoeff() <= tolerance);
  const double outside = move_ ? origin_monitor_.outside(position, counts()) : 0;
  if (detectNewOrigin(position, outside, isNewZero(position, kMargin), kMargin)) return;
  if (settled_ && !move_ && elsewhere) forgetSettings();
  if ((move_ || interrupted_) && faultBesideTheLine(position, kMargin)) return;
  const bool missed = move_ && (position - move_->to).cwiseAbs().maxCoeff() > tolerance;
  rest(position);
  reading_due_ = false;
  if (!settled_) {
    settled_ = true;
    confirmPositions();
  }
  if (!missed) {
    tries_ = 0;
  } else if (++tries_ >= kTries) {
    raiseFault("the move does not arrive: it was interrupted");
  }
}

void Mp285Driver::next() {
  if (!stop_requested_) return request(Kind::kStop, std::string(1, kMp285Stop));
  if (!status_requested_) return request(Kind::kStatus, mp285RequestStatus());
  if (!absolute_) return request(Kind::kAbsolute, mp285AbsoluteMode());
  if (reading_due_) return request(Kind::kPosition, mp285RequestPosition());
  if (goal() && mayMove() && !isAt(*position_, goalPosition())) return nextTowardsGoal();
  if (config_.rest_reading_interval > 0 && time() >= next_rest_reading_) reading_due_ = true;
}

/// True metres per metre of the device's own units along a displacement (microsteps), since the
/// axes' microsteps can differ.
double Mp285Driver::metresPerNominalMetre(const Eigen::Vector3d& displacement) const {
  return length(displacement) / (displacement.norm() * nominal_microstep_);
}

Mp285Driver::Speed Mp285Driver::speedFor(const Eigen::Vector3d& displacement) const {
  const double distance = displacement.norm();
  const double per_nominal = metresPerNominalMetre(displacement);
  int um_per_s =
      static_cast<int>(std::lround(std::min(requestedSpeed(displacement), config_.speed) / per_nominal * 1e6));
  um_per_s = std::max(um_per_s, goal()->follows ? kSlowestShortMove : 1);
  int fastest = std::max(1, static_cast<int>(fastestAlong(displacement) / per_nominal * 1e6 + 1e-6));  // um/s
  const bool fine = std::min(um_per_s, fastest) <= kFineLimit ||
                    distance < 10 * kCoarseStep;  // the rest of a coarse move is a fine move
  if (fine) fastest = std::min(fastest, static_cast<int>(kFineLimit));
  um_per_s = std::min(um_per_s, fastest);
  // Keeps a speed that is nearly right: setting it takes a third of the time of a move's exchange.
  if (goal()->follows && speed_ && speed_->fine == fine && speed_->um_per_s >= 0.9 * um_per_s &&
      speed_->um_per_s <= std::min<double>(1.5 * um_per_s, fastest)) {
    return *speed_;
  }
  return {um_per_s, fine};
}

void Mp285Driver::nextTowardsGoal() {
  const Eigen::Vector3d goal_position = goalPosition(), displacement = goal_position - *position_;
  const Speed speed = speedFor(displacement);
  if (!speed_ || !(*speed_ == speed)) {
    confirmed_.reset();
    speed_ = speed;  // if this fails, the next session discards it
    return request(Kind::kVelocity, mp285SetVelocity(speed.um_per_s, speed.fine));
  }
  const double rate = speed.um_per_s * 1e-6 / nominal_microstep_;  // microsteps/s
  Move move{*position_, goal_position, goal_position, goal()->follows, 0, 0};
  const double longest = std::max(rate * (goal()->follows ? 2 : kLongestPart) * config_.segment_time, 1.0);
  if (displacement.norm() > longest) move.to = (move.from + displacement.normalized() * longest).array().round();
  move.duration = (move.to - move.from).norm() / rate;
  Mp285Position position;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(move.to[i]) > 2e9) return raiseFault("the goal exceeds the range of the protocol");
    position[i] = static_cast<std::int32_t>(move.to[i]);
  }
  move.begin = time() + 14 * config_.byteTime();
  if (!line_ || goal()->follows || line_->goal != goal_position || !isAt(*position_, line_->next))
    line_ = Line{*position_, goal_position, move.to};
  line_->next = move.to;
  move_ = move;
  coarse_ = !speed.fine;
  origin_monitor_.setMove(move.to);
  request(Kind::kMove, mp285Move(position), 1.25 * timeLeft() + config_.move_allowance);
  extrapolateFor(timeLeft() + std::max(config_.move_allowance, kHeldReply + answer_time_));
}

}  // namespace microinjection
