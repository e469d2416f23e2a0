#include "rigs/zaber/zaber_driver.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kRetryPause = 0.02;   // s, after AGAIN and its like
constexpr int kTries = 3;              // of a message
constexpr double kLongestGuess = 0.2;  // s, that a position carried on says where an axis may be
constexpr int kStalls = 10;            // readings of an axis at rest that was told to move

std::string stopAll(const ZaberConfig& config) {
  std::string bytes;
  for (const ZaberAddress& address : config.addresses) bytes += zaberCommand(address, "stop", config.checksum);
  return bytes;
}

}  // namespace

ZaberDriver::ZaberDriver(const ZaberConfig& config, std::unique_ptr<Wire> wire)
    : SerialManipulator(std::move(wire),
                        {"Zaber", stopAll(config), config.answer_time + 60 * config.byteTime() + 5e-3,
                         config.reply_timeout + (kZaberCommandBytes + kZaberReplyBytes) * config.byteTime()}),
      config_(config),
      parser_(config.reply_checksum),
      may_home_(config.home) {}

double ZaberDriver::gain() const {
  // A loop with a dead time T is well damped up to a gain of about 0.4 / T; a turn is six exchanges.
  return config_.gain > 0 ? config_.gain : 0.3 / (7 * config_.exchangeTime());
}

/// How old (s) a position may be: two turns, one answer that is missed, and a stop, in which an axis is asked alone.
double ZaberDriver::longestAge() const {
  return 2 * abilities().reading_interval + config_.reply_timeout + config_.speed / config_.acceleration;
}

double ZaberDriver::fastest(int i) const { return std::min(config_.speed, speedLimits()[i]); }

/// Of a speed (m/s), never rounded beyond the axis' fastest.
long long ZaberDriver::speedData(int i, double speed) const {
  const double unit = config_.microsteps_per_metre[i] * kZaberSpeedUnit;
  const auto most = static_cast<long long>(fastest(i) * unit);
  return std::clamp(std::llround(speed * unit), -most, most);
}

ManipulatorAbilities ZaberDriver::abilities() const {
  ManipulatorAbilities abilities;
  const auto runs_on = [](const Axis& axis) { return !axis.moves_have_speeds.value_or(true); };
  const bool old = std::any_of(axes_.begin(), axes_.end(), runs_on);
  abilities.device = old ? "Zaber (ASCII protocol; firmware before 7.25, a velocity does not end by itself)"
                         : "Zaber (ASCII protocol)";
  abilities.follows = true;
  abilities.command_interval = abilities.reading_interval = config_.turnTime();
  abilities.resolution = 1 / config_.microsteps_per_metre.minCoeff();
  abilities.speed = std::min(config_.speed, speedLimits().maxCoeff());
  abilities.latency = 4 * config_.exchangeTime();  // half a turn to wait, and its own way
  const double wire = stopAll(config_).size() * config_.byteTime();
  abilities.stop_time = wire + config_.answer_time + abilities.speed / config_.acceleration;
  return abilities;
}

double ZaberDriver::expected(int i, double at) const {
  const Axis& axis = axes_[i];
  if (!axis.position) return std::nan("");
  const double way = axis.velocity * std::max(0.0, at - axis.position_time);
  if (std::isnan(axis.end)) return *axis.position + way;
  const double left = axis.end - *axis.position;
  return *axis.position + (std::abs(way) < std::abs(left) ? way : left);  // never past the end of the move
}

std::optional<ManipulatorDevice::Reading> ZaberDriver::reading() const {
  Eigen::Vector3d device, velocity;
  for (int i = 0; i < 3; ++i) {
    if (!axes_[i].position || !sure()) return std::nullopt;
    device[i] = expected(i, time());
    velocity[i] = !std::isnan(axes_[i].end) && device[i] == axes_[i].end ? 0 : axes_[i].velocity;
  }
  return Reading{config_.joints.toJoints(device), config_.joints.directions.cwiseProduct(velocity)};
}

bool ZaberDriver::moving() const {
  if (!goal()) return std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.busy; });
  if (!goal()->follows) return !move_done_;
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  for (int i = 0; i < 3; ++i) {
    const double away = std::abs(wanted[i] - axes_[i].position.value_or(wanted[i]));
    if (axes_[i].told.value_or(1) != 0 || away > 1 / config_.microsteps_per_metre[i]) return true;
    if (axes_[i].busy || !axes_[i].read_since_told || axes_[i].filter.doubts()) return true;
  }
  return false;
}

void ZaberDriver::connected() {
  for (Axis& axis : axes_) {
    axis.moves_have_speeds.reset();
    axis.lowest.reset();
    axis.highest.reset();
  }
}

void ZaberDriver::begin(bool /*lost*/) {
  exchange_.reset();
  parser_.forget();
  begun_ = listened();
  settled_ = false;
  setting_.clear();
  turn_ = move_stage_ = setting_tries_ = 0;
  for (Axis& axis : axes_) {
    axis.filter.forget();
    axis.told.reset();
    axis.velocity = 0;
    axis.end = std::nan("");
    axis.read_since_begin = axis.homed = axis.still_moves = false;
    axis.busy = axis.has_reference = true;
    axis.cleared = !clearing();
    axis.stalls = 0;
  }
}

void ZaberDriver::goalChanged() {
  move_stage_ = move_tries_ = 0;
  move_done_ = false;
}

void ZaberDriver::talk(const std::string& bytes) {
  for (const ZaberMessage& message : parser_.feed(bytes)) {
    handle(message);
    if (!talking()) return;
  }
  if (exchange_ && listened() > exchange_->due) exchange_->sent ? missedReply() : sendExchange();
  if (!exchange_ && talking()) next();
}

int ZaberDriver::axisOf(const ZaberAddress& address) const {
  const auto found = std::find(config_.addresses.begin(), config_.addresses.end(), address);
  return found == config_.addresses.end() ? -1 : static_cast<int>(found - config_.addresses.begin());
}

std::string ZaberDriver::axisName(int axis) const {
  const ZaberAddress& address = config_.addresses[axis];
  return "axis " + std::to_string(address.axis) + " of device " + std::to_string(address.device);
}

void ZaberDriver::handle(const ZaberMessage& message) {
  const int axis = axisOf(message.from);
  if (message.kind == ZaberMessage::Kind::kReply) {
    const bool awaited = exchange_ && exchange_->sent && message.from == exchange_->to &&
                         (!config_.numbers || message.number == number_);
    if (awaited) handleReply(message);
  } else if (message.kind == ZaberMessage::Kind::kAlert && axis >= 0) {
    takeFlag(message, axis);
  }
}

void ZaberDriver::takeFlag(const ZaberMessage& message, int axis) {
  const bool told_already = state() == State::kFault && !clearing();
  if (isZaberFault(message.flag) && !told_already) {
    return raiseFault(axisName(axis) + " reports fault " + message.flag);
  }
  axes_[axis].has_reference = message.flag != "WR";
  if (message.flag[0] == 'W') note_ = axisName(axis) + " warns " + message.flag;
}

void ZaberDriver::handleReply(const ZaberMessage& reply) {
  const Exchange done = *exchange_;
  if (reply.rejected) return handleRejection(reply);
  Axis& axis = axes_[done.axis];
  if (done.kind == Kind::kPosition) {
    if (!reply.position()) return;  // a belated answer to something else; its own is still to come
  } else {
    understood();
    exchange_.reset();
  }
  if (done.kind == Kind::kVersion) return takeSetting(done, reply);  // of the whole device, as its flag is
  if (done.kind != Kind::kClear) takeFlag(reply, done.axis);
  if (!talking()) return;
  axis.busy = reply.busy;
  const double speed_unit = config_.microsteps_per_metre[done.axis] * kZaberSpeedUnit;  // for 1 m/s
  switch (done.kind) {
    case Kind::kPosition:
      axis.still_moves = reply.busy;
      takePosition(reply);
      break;
    case Kind::kVelocity:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.velocity = done.value / speed_unit;
      axis.end = done.end;
      axis.told = done.value;
      axis.read_since_told = false;
      break;
    case Kind::kMove:
      axis.position = expected(done.axis, time());
      axis.position_time = time();
      axis.end = done.value / config_.microsteps_per_metre[done.axis];
      axis.velocity = std::copysign(axis.move_speed, axis.end - *axis.position);
      axis.told.reset();
      axis.read_since_told = false;
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
    case Kind::kVersion:
    case Kind::kLowest:
    case Kind::kHighest:
      takeSetting(done, reply);
      break;
  }
}

void ZaberDriver::handleRejection(const ZaberMessage& reply) {
  takeFlag(reply, exchange_->axis);
  if (!talking()) return;
  // It is busy, or the command reached it damaged. A rejected command has done nothing and may be said again.
  const bool later = reply.data == "AGAIN" || reply.data == "STATUSBUSY" || reply.data == "FULL";
  const bool damaged = reply.data == "BADCOMMAND";
  if ((later || damaged) && exchange_->tries < kTries) {
    exchange_->sent = false;
    exchange_->due = listened() + kRetryPause;
    return;
  }
  raiseFault(axisName(exchange_->axis) + " refuses \"" + exchange_->text + "\": " + reply.data);
}

void ZaberDriver::takePosition(const ZaberMessage& reply) {
  const int i = exchange_->axis;
  Axis& axis = axes_[i];
  understood();
  exchange_.reset();
  const double place = *reply.position() / config_.microsteps_per_metre[i];
  const double then = time() - (kZaberReplyBytes * config_.byteTime() + config_.answer_time / 2);  // when it was there
  const double guess = expected(i, then);
  const double step = 1 / config_.microsteps_per_metre[i];
  const double since = std::clamp(time() - axis.position_time, 0.0, kLongestGuess) + config_.exchangeTime();
  const bool rests = !reply.busy && axis.velocity == 0;
  const double tolerance = rests ? 2.5 * step : config_.reading_margin + std::abs(axis.velocity) * since;
  const double agreement = reply.busy ? config_.reading_margin / 2 + config_.speed * config_.turnTime() : 2.5 * step;
  using Coordinate = Eigen::VectorXd;
  if (!axis.filter.accept(Coordinate::Constant(1, place), Coordinate::Constant(1, guess), tolerance, agreement)) return;
  if (axis.read_since_begin) largest_correction_ = std::max(largest_correction_, std::abs(place - guess));
  const bool stands = axis.position && std::abs(place - *axis.position) < 0.5 * step;
  axis.position = place;
  axis.position_time = then;
  axis.heard = listened();
  trustFor(std::min({axes_[0].heard, axes_[1].heard, axes_[2].heard}) + longestAge() - listened());
  axis.read_since_begin = axis.read_since_told = true;
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
  const Exchange lost = *exchange_;
  lostStep("no answer of " + axisName(lost.axis) + " to \"" + lost.text + "\"");
}

void ZaberDriver::ask(Kind kind, int axis, const std::string& command, long long value, double end) {
  ZaberAddress to = config_.addresses[axis];
  if (kind == Kind::kVersion) to.axis = 0;
  exchange_ = Exchange{kind, axis, to, value, end, command, 0, 0, false};
  sendExchange();
}

void ZaberDriver::sendExchange() {
  std::optional<int> number;
  if (config_.numbers) number = number_ = (number_ + 1) % 100;
  const std::string bytes = zaberCommand(exchange_->to, exchange_->text, config_.checksum, number);
  ++exchange_->tries;
  exchange_->sent = true;
  exchange_->due = listened() + (bytes.size() + kZaberReplyBytes) * config_.byteTime() + config_.reply_timeout;
  say(bytes);
}

}  // namespace microinjection
