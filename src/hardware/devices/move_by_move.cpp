#include "hardware/devices/move_by_move.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kWorthStopping = 0.15;  // s left of a move; to abort it and start another takes as long

}  // namespace

void MoveByMoveConfig::readCommon(ConfigReader& reader, int default_baud, const Range& speeds,
                                  const Range& rest_readings) {
  ConfigReader line = reader.section("port", ConfigReader::kRequired);
  port = SerialPortConfig::read(line, default_baud);
  axes = AxisOrder::read(reader);
  joints = JointAxes::read(reader);
  reader.number("speed", speed, speeds);
  reader.number("segment_time", segment_time, {0.01, 1});
  reader.number("answer_time", answer_time, Range::nonNegative());
  reader.number("reply_timeout", reply_timeout, Range::positive());
  reader.number("rest_reading_interval", rest_reading_interval, rest_readings);
}

MoveByMove::MoveByMove(const MoveByMoveConfig& config, std::unique_ptr<Wire> wire, const Link& link,
                       std::size_t longest_move)
    : SerialManipulator(std::move(wire), link),
      common_(config),
      answer_time_(config.answer_time),
      stop_bytes_(static_cast<double>(link.stop.size())),
      longest_move_(static_cast<double>(longest_move)) {}

ManipulatorAbilities MoveByMove::abilitiesWith(double turn) const {
  ManipulatorAbilities abilities;
  abilities.follows = false;
  abilities.command_interval = abilities.reading_interval = turn;
  abilities.resolution = counts().maxCoeff() * std::max(1.0, arrival());
  abilities.speed = std::min(common_.speed, speedLimits().maxCoeff());
  // A set-point waits for the move in progress before it is sent.
  abilities.latency = turn + longest_move_ * common_.byteTime() + answer_time_;
  abilities.stop_time = stop_bytes_ * common_.byteTime() + common_.answer_time;
  return abilities;
}

void MoveByMove::measure(double sent, std::size_t reply_bytes) {
  if (reply_times_.measured()) return;
  reply_times_.add(activeTime() - sent - static_cast<double>(reply_bytes) * common_.byteTime());
  answer_time_ = std::max(common_.answer_time, reply_times_.measured().value_or(0));
}

Eigen::Vector3d MoveByMove::extrapolatedPosition(double at) const {
  if (!move_) return *position_;
  const double elapsed = std::max(0.0, at - move_->begin);
  if (elapsed >= move_->duration) return move_->to;
  return move_->from + (move_->to - move_->from) * (elapsed / move_->duration);
}

std::optional<ManipulatorDevice::Reading> MoveByMove::reading() const {
  if (!position_ || !positionsValid() || (settled_ && filter_.isContradicted())) return std::nullopt;
  if (unconfirmed_ || isUnconfirmed()) return std::nullopt;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (timeLeft() > 0 && time() > move_->begin) {
    velocity = (move_->to - move_->from).cwiseProduct(counts()) / move_->duration;
  }
  return Reading{
      common_.joints.toJoints(common_.axes.inJointOrder(extrapolatedPosition(time()).cwiseProduct(counts()))),
      common_.joints.directions.cwiseProduct(common_.axes.inJointOrder(velocity))};
}

Eigen::Vector3d MoveByMove::goalPosition() const {
  const Eigen::Vector3d device = common_.axes.inDeviceOrder(common_.joints.toDevice(goal()->joints));
  return device.cwiseQuotient(counts()).array().round();
}

bool MoveByMove::isAt(const Eigen::Vector3d& position, const Eigen::Vector3d& goal) const {
  return (position - goal).cwiseAbs().maxCoeff() <= arrival();
}

bool MoveByMove::moving() const {
  if (!goal()) return !settled_;
  return move_ || !settled_ || !position_ || !isAt(*position_, goalPosition());
}

double MoveByMove::requestedSpeed(const Eigen::Vector3d& displacement) const {
  if (!goal()->follows) return goal()->speed;
  return std::max(1.2 * goal()->velocity.norm(), length(displacement) / common_.segment_time);
}

double MoveByMove::fastestAlong(const Eigen::Vector3d& displacement) const {
  const Eigen::Vector3d direction =
      common_.axes.inJointOrder(displacement.cwiseProduct(counts()).normalized()).cwiseAbs();
  return std::min(common_.speed, speedLimits().cwiseQuotient(direction).minCoeff());
}

/// Returns whether to abort the move in progress for a newer goal. A short move towards a set-point
/// is not aborted for another set-point. It takes about segment_time, and a stream has a newer
/// set-point in each step. With any limit below segment_time each move would be aborted and the
/// needle would rest most of the time.
bool MoveByMove::isOutdated() const {
  if (!goal() || timeLeft() <= kWorthStopping) return false;
  if (move_->follows || goal()->follows) return move_->follows != goal()->follows;
  return !isAt(move_->goal, goalPosition());
}

double MoveByMove::besideTheLine(const Eigen::Vector3d& position) const {
  if (!line_) return 0;
  const Eigen::Vector3d way = (line_->goal - line_->begin).cwiseProduct(counts());
  const Eigen::Vector3d here = (position - line_->begin).cwiseProduct(counts());
  const double length = way.norm();
  if (length == 0) return here.norm();
  const double along = std::clamp(here.dot(way) / length, 0.0, length);
  return (here - way * (along / length)).norm();
}

bool MoveByMove::faultBesideTheLine(const Eigen::Vector3d& position, double margin) {
  const double beside = besideTheLine(position);
  if (beside <= margin) return false;
  raiseFault("it is " + std::to_string(std::lround(beside * 1e6)) +
             " um beside the straight way to its goal: the line changes bytes, or something else moves the device; "
             "check cable, port and what holds it, then enable");
  return true;
}

void MoveByMove::begin(bool /*lost*/) {
  filter_.clear();
  settled_ = false;
  if (!clearing()) return;
  origin_lost_ = interrupted_ = false;  // wherever it is found, from there on
}

void MoveByMove::onStopSent() {
  if (position_) position_ = extrapolatedPosition(time() + stop_bytes_ * common_.byteTime());
  interrupted_ = interrupted_ || move_;
  unconfirmed_ = unconfirmed_ || isUnconfirmed();
  move_.reset();
  settled_ = false;
  maxValidityTime(2 * (common_.reply_timeout + longest_move_ * common_.byteTime()) + recoveryTime());
}

/// Records the position at rest until the next reading.
void MoveByMove::rest(const Eigen::Vector3d& position) {
  position_ = position;
  move_.reset();
  interrupted_ = unconfirmed_ = false;
  origin_monitor_.setAtRest(position);
  settings_lost_ = false;
  next_rest_reading_ = time() + common_.rest_reading_interval;
  validityTime(std::numeric_limits<double>::infinity());
}

/// Returns whether a position is exactly 0, where a device begins to count, although this device
/// was elsewhere. A device that has lost its settings was switched off, also if 0 is an end of its
/// move.
bool MoveByMove::isNewZero(const Eigen::Vector3d& position, double margin) const {
  if (!position.isZero(kSame)) return false;
  if (settings_lost_) return !origin_monitor_.remainsAt(position, counts(), margin);
  if (origin_monitor_.mayStandAt(position, counts(), margin)) return false;
  return !position_ || length(extrapolatedPosition(time()) - position) > margin;
}

/// Detects that the device's coordinates have begun anew; earlier positions are then void.
/// `outside` (m): distance of the reading from the possible positions. `new_zero`: the reading is
/// the position at which a device begins to count.
bool MoveByMove::detectNewOrigin(const Eigen::Vector3d& position, double outside, bool new_zero, double margin) {
  if (origin_lost_) return true;
  if (outside <= margin && !new_zero) return false;
  const double distance = position_ ? length(position - extrapolatedPosition(time())) : outside;
  position_.reset();
  origin_monitor_.clear();
  origin_lost_ = true;  // so that no position is reported
  raiseFault("it reports a position " + std::to_string(std::lround(distance * 1e6)) +
             " um from the possible ones: if it was switched off, its coordinates began anew; check them, then enable");
  return true;
}

}  // namespace microinjection
