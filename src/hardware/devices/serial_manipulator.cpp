#include "hardware/devices/serial_manipulator.h"

#include <utility>

#include "hardware/devices/known_answers.h"

namespace microinjection {
namespace {

constexpr double kOpenInterval = 0.5;   // s, between attempts to open the line
constexpr double kStopInterval = 0.5;   // s, between stops without a guard
constexpr double kLongestDrain = 2;     // s; a line that is never silent is not the device's
constexpr double kLongestGap = 0.02;    // s between two steps; in a longer gap a late reply is not the device's fault
constexpr double kPauseInFault = 0.5;   // s, between attempts in a fault
constexpr int kAttempts = 3;            // successive failures that cause a fault
constexpr double kStreamEnds = 0.1;     // s; a longer pause ends a stream of set-points
constexpr std::size_t kHeard = 256;     // bytes, for a name of what answers
constexpr int kSuccessesToForget = 12;  // successful exchanges that reset the count of failures

}  // namespace

SerialManipulator::SerialManipulator(std::unique_ptr<Wire> wire, const Link& link)
    : wire_(std::move(wire)), link_(link), reason_(link.device + ": not connected yet") {
  wire_->setGuardedStop(link_.stop);  // a node that is killed or frozen must not leave a device in motion
}

SerialManipulator::~SerialManipulator() {
  if (wire_->isOpen() && known_) wire_->write(link_.stop + link_.farewell, time_);
}

void SerialManipulator::askFirst(const PortProbe::Question& question) {
  probe_.setQuestion(question);
  known_ = false;
  wire_->setGuardedStop("");
}

void SerialManipulator::beginLine() {
  was_open_ = lost_ = true;
  served_ = false;
  heard_.clear();
  reason_ = link_.device + ": connected, no reply yet";
  connected();
  if (known_) return beginSession(link_.quiet_after_loss);
  probe_.begin(active_time_);
}

void SerialManipulator::probe(const std::string& bytes) {
  if (!fault_.empty() && !clearing_) return;
  if (std::exchange(stop_wanted_, false) && clearing_) probe_.begin(active_time_);
  switch (probe_.step(bytes, active_time_, [this](const std::string& request) { send(request); })) {
    case PortProbe::Verdict::kAsks:
      return;
    case PortProbe::Verdict::kKnown:
      known_ = true;
      wire_->setGuardedStop(link_.stop);
      return beginSession(link_.quiet_after_loss);
    case PortProbe::Verdict::kOther:
      fault_ = link_.device + ": " + probe_.reason();
      clearing_ = false;
      lost_ = true;
      dropGoal();
  }
}

/// A reason on a line that has never served, with the other device that answers there.
std::string SerialManipulator::withOther(const std::string& reason) const {
  const std::string name = served_ ? "" : nameOfAnswer(heard_);
  const bool own = name.empty() || name.find(link_.device) != std::string::npos || name.rfind("something", 0) == 0;
  return own ? reason : reason + "; " + name + " answers: is it the right port?";
}

void SerialManipulator::follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) {
  if (!mayMove() || !joints.allFinite() || !velocity.allFinite()) return;
  const bool same = goal_ && goal_->follows && goal_->joints == joints && goal_->velocity == velocity;
  goal_ = Goal{true, joints, velocity, 0, time_};
  stopped_ = false;
  if (!same) goalChanged();
}

void SerialManipulator::moveTo(const Eigen::Vector3d& joints, double speed) {
  if (!mayMove() || !joints.allFinite() || !(speed > 0)) return;
  const bool same = goal_ && !goal_->follows && goal_->joints == joints && goal_->speed == speed;
  goal_ = Goal{false, joints, Eigen::Vector3d::Zero(), speed, time_};
  stopped_ = false;
  if (!same) goalChanged();
}

void SerialManipulator::dropGoal() {
  goal_.reset();
  goalChanged();
}

void SerialManipulator::stop() {
  onStopCommand();
  dropGoal();
  if (!stopped_) stop_wanted_ = true;  // repeated stops must not prevent readings
}

void SerialManipulator::clearFault() {
  if (fault_.empty() || clearing_) return;
  clearing_ = true;
  failures_ = 0;
  stop_wanted_ = true;
}

void SerialManipulator::beginSession(double quiet) {
  wire_->write(link_.stop, time_);
  onStopSent();
  stopped_ = !goal_;
  exchanging_ = false;
  drain_since_ = last_byte_ = active_time_;
  quiet_ = quiet;
}

void SerialManipulator::stopUnheard() {
  lost_ = true;
  beginSession(link_.quiet_after_loss);
}

void SerialManipulator::stopFirst() { beginSession(link_.quiet_in_step); }

void SerialManipulator::connectionLost() {
  if (probe_.asks()) {
    known_ = false;
    wire_->setGuardedStop("");  // until it is known who would hear it
  }
  was_open_ = exchanging_ = ready_ = positions_valid_ = stop_wanted_ = false;
  next_open_ = time_ + kOpenInterval;
  reason_ = link_.device + ": the line broke; trying again";
  dropGoal();
}

/// Returns whether the device may continue. After an intervention a new session begins with another
/// stop, since the guard may have been lost before it sent one.
bool SerialManipulator::guarded() {
  const Wire::GuardReport guard = wire_->heartbeat();
  const bool missing = !guard.missing.empty();
  if (!missing && guard.intervention.empty()) return true;
  reason_ = link_.device + ": " + (missing ? "no stop guard: " + guard.missing : guard.intervention);
  if (guard.intervention.empty() && time_ < next_stop_) return false;
  next_stop_ = time_ + kStopInterval;
  ready_ = positions_valid_ = stop_wanted_ = false;
  lost_ = true;
  dropGoal();
  guardIntervened();
  beginSession(link_.quiet_after_loss);
  return false;
}

void SerialManipulator::exchangeFailed(const std::string& reason) {
  successes_ = 0;
  lost_ = true;
  if (++failures_ >= kAttempts) {
    raiseFault(reason);
  } else {
    beginSession(link_.quiet_after_loss);
  }
}

/// Without a valid position the device counts as disconnected. It is stopped, and no command waits
/// for it.
void SerialManipulator::disconnect() {
  positions_valid_ = ready_ = false;
  reason_ = link_.device + ": no valid position for too long; trying again";
  dropGoal();
  exchangeFailed("no reply with its position");
}

void SerialManipulator::raiseFault(const std::string& reason) {
  const bool again = !fault_.empty() && !clearing_;
  fault_ = link_.device + ": " + withOther(reason);
  clearing_ = positions_valid_ = false;
  lost_ = true;
  dropGoal();
  beginSession(again ? std::max(kPauseInFault, link_.quiet_after_loss) : link_.quiet_after_loss);
}

void SerialManipulator::confirmPositions() {
  ready_ = positions_valid_ = served_ = true;
  if (clearing_) fault_.clear();
  clearing_ = false;
}

void SerialManipulator::exchangeSucceeded() {
  if (++successes_ >= kSuccessesToForget) failures_ = 0;
}

/// Removes a reached goal, so that the driver does not work against an operator who turns the
/// device's hand wheel or knob.
void SerialManipulator::clearReachedGoal() {
  const bool goes_on = goal_ && goal_->follows && time_ - goal_->time < kStreamEnds;
  if (goal_ && !goes_on && mayMove() && !moving()) dropGoal();
}

/// Whether something else has come than lines that the device sends by itself, whole and printable,
/// such as a Zaber's info lines: of these there may be so many that the line is never silent.
bool SerialManipulator::isNoise(const std::string& bytes) {
  constexpr std::size_t kLongestNotice = 256;  // characters
  if (link_.notice.empty()) return !bytes.empty();
  bool noise = false;
  for (const char each : bytes) {
    notice_ += each;
    const bool begins = notice_.compare(0, link_.notice.size(), link_.notice, 0, notice_.size()) == 0;
    const bool printable = each == '\r' || each == '\n' || (each >= ' ' && each <= '~');
    noise = noise || !begins || !printable || notice_.size() > kLongestNotice;
    if (!begins || !printable || each == '\n' || notice_.size() > kLongestNotice) notice_.clear();
  }
  return noise;
}

void SerialManipulator::step(double time) {
  active_time_ += std::min(time - time_, kLongestGap);
  time_ = time;
  if (!wire_->isOpen()) {
    if (was_open_) connectionLost();
    if (time < next_open_) return;
    next_open_ = time + kOpenInterval;
    reason_ = wire_->open();
    if (!reason_.empty()) return;
    beginLine();
  }
  std::string bytes = wire_->read(time);
  if (!wire_->isOpen()) return connectionLost();
  if (!known_) return probe(bytes);
  if (!served_ && heard_.size() < kHeard) heard_ += bytes;
  if (!guarded()) return;
  if (positions_valid_ && active_time_ > valid_until_) return disconnect();
  if (stop_wanted_) {
    stop_wanted_ = false;
    beginSession(exchanging_ && !clearing_ ? link_.quiet_in_step : std::max(quiet_, link_.quiet_in_step));
  }
  if (!exchanging_) {
    if (isNoise(bytes)) last_byte_ = active_time_;
    if (active_time_ - drain_since_ > kLongestDrain)
      return exchangeFailed("the line is never silent; is it the right port?");
    if (active_time_ - last_byte_ < quiet_) return;
    bytes.clear();
    exchanging_ = true;
    begin(lost_);
    lost_ = false;
  }
  exchange(bytes);
  clearReachedGoal();
}

ManipulatorDevice::State SerialManipulator::state() const {
  if (!wire_->isOpen()) return State::kDisconnected;
  if (!fault_.empty()) return State::kFault;
  return ready_ ? State::kReady : State::kDisconnected;
}

std::string SerialManipulator::reason() const {
  switch (state()) {
    case State::kReady:
      return "";
    case State::kFault:
      return fault_;
    default:
      return reason_;
  }
}

}  // namespace microinjection
