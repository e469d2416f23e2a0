#include "nodes/needle/external_manipulator.h"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "base/operating_state.h"
#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

using cell_microinjection::StringStamped;
using geometry_msgs::PoseStamped;
using sensor_msgs::JointState;

constexpr double kWindow = 0.5;       // s, in which the rate is measured
constexpr double kLeastShare = 0.8;   // of the told rate
constexpr double kRest = 0.02;        // s, in which a needle at rest moves no farther than the resolution
constexpr double kStreamEnds = 0.1;   // s; a longer pause ends a stream of set-points
constexpr double kTimeToEnable = 1;   // s, for which a node that was asked to enable itself may still tell its FAULT
constexpr double kUnreached = 1;      // s, after which a set-point that is not reached is worth a note
constexpr double kSpeedMargin = 1.5;  // of a leap over what the axes' speed allows
constexpr double kPathKept = 2;       // s

std::string micrometres(double metres) {
  std::ostringstream text;
  text.precision(3);
  text << 1e6 * metres << " um";
  return text.str();
}
std::string numberOf(double value, const char* unit) {
  std::ostringstream text;
  text.precision(3);
  text << value << ' ' << unit;
  return text.str();
}

}  // namespace

ExternalManipulatorConfig ExternalManipulatorConfig::read(ConfigReader& reader) {
  ExternalManipulatorConfig config;
  reader.text("namespace", config.name_space);
  if (!std::regex_match(config.name_space, std::regex("(/[A-Za-z][A-Za-z0-9_]*)+")) || config.name_space == "/needle")
    reader.error("namespace", "must be the namespace of your node's topics, such as /my_rig");
  std::string positions = "joints";
  reader.choice("positions", positions, {"joints", "poses"});
  config.joints_told = positions == "joints";
  reader.texts("joints", config.joints);
  if (config.joints.size() != 3 || std::set<std::string>(config.joints.begin(), config.joints.end()).size() != 3)
    reader.error("joints", "must be three different names");
  reader.text("frame", config.frame);
  config.axes = JointAxes::read(reader);
  if (config.inWorld() && config.axes.directions != Eigen::Vector3d::Ones())
    reader.error("directions", "must be [1, 1, 1] with positions = poses and frame = world");
  if (config.inWorld() && !config.axes.origin.isZero(0))
    reader.error("origin", "must be [0, 0, 0] with positions = poses and frame = world");
  reader.number("rate", config.rate, Range::closed(20, 1000));
  reader.number("lag", config.lag, {0, 0.5, true, false});
  reader.number("timeout", config.timeout, {0, 1, true, false});
  reader.number("resolution", config.resolution, Range::positive());
  reader.number("path_tolerance", config.path_tolerance, Range::positive());
  if (config.timeout < 2 / config.rate)
    reader.error("timeout", "must be at least two periods of rate, " + numberOf(2 / config.rate, "s"));
  if (config.path_tolerance < 2 * config.resolution)
    reader.error("path_tolerance", "must be at least twice the resolution");
  return config;
}

ExternalManipulator::ExternalManipulator(Cycle& cycle, const ManipulatorGeometry& geometry,
                                         const ExternalManipulatorConfig& config)
    : cycle_(cycle),
      geometry_(geometry),
      config_(config),
      state_input_(cycle.input<cell_microinjection::OperatingState>(topic("operating_state"), InputPhase::kSampled,
                                                                    std::numeric_limits<double>::infinity())),
      path_(kPathKept) {
  subscribe();
}

void ExternalManipulator::subscribe() {
  state_input_.onMessage(
      [this](const cell_microinjection::OperatingState& message, const ros::Time& time) { onState(message, time); });
  words_ = cycle_.bus().advertise<StringStamped>(topic("state_command"), 10);
  if (config_.joints_told) {
    auto& input = cycle_.input<JointState>(topic("measured_js"), InputPhase::kSampled, config_.timeout);
    input.onMessage([this, &input](const JointState& message, const ros::Time& now) { receive(input, message, now); });
    measured_ = &input;
    joint_commands_ = advertise<JointState>("servo_jp");
  } else {
    auto& input = cycle_.input<PoseStamped>(topic("measured_cp"), InputPhase::kSampled, config_.timeout);
    input.onMessage([this, &input](const PoseStamped& message, const ros::Time& now) { receive(input, message, now); });
    measured_ = &input;
    pose_commands_ = advertise<PoseStamped>("servo_cp");
  }
}

/// Advertises the topic of the set-points, and hears who else commands there.
template <typename Message>
Publisher<Message> ExternalManipulator::advertise(const std::string& name) {
  Bus& bus = cycle_.bus();
  const std::string topic = this->topic(name);
  rivals_ = bus.subscribe<Message>(topic, 10, [this, &bus, topic](const Delivery<Message>& delivery) {
    if (delivery.raw.sender != bus.name())
      raiseFault("two nodes command it on " + topic + ": " + bus.name() + " and " + delivery.raw.sender);
  });
  return bus.advertise<Message>(topic, 10);
}

// What it tells

/// Returns why the message is not valid; empty: it is.
std::string ExternalManipulator::toJoints(const JointState& message, Eigen::Vector3d& joints) const {
  Eigen::Vector3d positions;
  for (int i = 0; i < 3; ++i) {
    const auto found = std::find(message.name.begin(), message.name.end(), config_.joints[i]);
    const std::size_t place = found - message.name.begin();
    if (found == message.name.end() || place >= message.position.size())
      return "it has no position of the joint " + config_.joints[i];
    positions[i] = message.position[place];
  }
  if (!isWithin(positions, kLargestNeedleDistance)) return "its positions are not finite, or beyond 1 m";
  joints = config_.axes.toJoints(positions);
  return "";
}

std::string ExternalManipulator::toJoints(const PoseStamped& message, Eigen::Vector3d& joints) {
  const bool nameless = message.header.frame_id.empty();
  if (!nameless && message.header.frame_id != config_.frame)
    return "its frame is " + message.header.frame_id + ", must be " + config_.frame;
  PoseStamped in_world = message;
  in_world.header.frame_id = kWorldFrame;
  const auto pose = validPose(&in_world);
  if (!pose) return "its pose is not finite, beyond 1 m, or its quaternion not of unit length";
  joints = config_.inWorld() ? geometry_.joints(pose->translation()) : config_.axes.toJoints(pose->translation());
  orientation_ = message.pose.orientation;
  return "";
}

template <typename Message>
void ExternalManipulator::receive(Input<Message>& input, const Message& message, const ros::Time& now) {
  if (const std::string rivals = input.rivals(now); !rivals.empty())
    return distrust("it is sent by two nodes, " + rivals);
  if (message.header.stamp.isZero()) return distrust("its stamp is 0: it is not valid");
  Measured measured{std::min(message.header.stamp, now), Eigen::Vector3d::Zero()};
  if (const std::string wrong = toJoints(message, measured.joints); !wrong.empty()) return distrust(wrong);
  repeats_ = last_ && measured.time <= last_->time;
  if (repeats_) return;  // the input's age grows
  age_ = secondsBetween(measured.time, now);
  take(measured);
}

/// Whether a position (m) cannot follow the last one after `pause` (s). In a pause without positions it may only have
/// gone on to the last set-point.
bool ExternalManipulator::isElsewhere(const Eigen::Vector3d& joints, double pause) const {
  if (pause > config_.timeout) {
    CommandedPath way(1);
    way.add(0, last_->joints);
    way.add(1, coasts_to_.value_or(last_->joints));
    return way.nearest(joints, 0, 1).distance > config_.path_tolerance;
  }
  // A node may stamp positions somewhat unevenly.
  const double moving = kSpeedMargin * std::max(pause, 1 / config_.rate);
  const Eigen::Array3d allowed = moving * geometry_.velocities().array() + config_.path_tolerance;
  return ((joints - last_->joints).array().abs() > allowed).any();
}

void ExternalManipulator::take(const Measured& measured) {
  if (last_) {
    const double pause = secondsBetween(last_->time, measured.time);
    const Eigen::Vector3d way = measured.joints - last_->joints;
    if (isElsewhere(measured.joints, pause)) {
      displaced_ = true;
      raiseFault("its position is " + micrometres(way.norm()) + " from the one " + numberOf(pause, "s") +
                 " before; check its origin, then enable");
    }
  }
  if (since_.isZero()) since_ = measured.time;
  distrust_.clear();
  last_ = measured;
  readings_.push_back(measured);
  while (secondsBetween(readings_.front().time, measured.time) > kWindow) readings_.pop_front();
  checkPath(measured);
}

/// It is on the path that was commanded within its lag; else it is slower than it says, or follows something else.
void ExternalManipulator::checkPath(const Measured& measured) {
  const double time = measured.time.toSec();
  if (!goal_ || path_.empty() || time < path_.begin()) return;
  const Eigen::Vector3d place = geometry_.tip(measured.joints);
  const bool moves = path_.length(time - config_.lag, time) > config_.path_tolerance;
  const double lag = moves ? time - path_.nearest(place, path_.begin(), time).time : 0;
  largest_lag_ = std::max(largest_lag_, lag);
  const double off = path_.nearest(place, time - config_.lag, time).distance;
  if (off <= config_.path_tolerance) return;
  raiseFault("the needle is " + micrometres(off) + " off the path that was commanded in the last " +
             numberOf(config_.lag, "s") + " (lag), allowed " + micrometres(config_.path_tolerance) +
             " (path_tolerance): it is later than it says, or something else moves it");
}

void ExternalManipulator::onState(const cell_microinjection::OperatingState& message, const ros::Time& time) {
  node_ = message;
  const bool asked = !asked_.isZero() && !isDue(asked_, time, kTimeToEnable);
  if (node_.state == toText(OperatingState::kFault) && !asked) raiseFault("it is in FAULT");
}

void ExternalManipulator::distrust(const std::string& why) {
  distrust_ = before_ = why;
  reason_ = measured_->topic + ": " + why;
  since_ = ros::Time();
  readings_.clear();
  trusted_ = false;
}

/// Why its positions do not count; empty: they do.
std::string ExternalManipulator::positionsReason(const ros::Time& now) {
  trusted_ = false;
  if (measured_->disconnected) distrust("the ROS master is lost");
  if (!since_.isZero() && measured_->age(now) > config_.timeout) {
    const std::string age = numberOf(measured_->age(now), "s");
    distrust(repeats_ ? "it repeats a stamp that is " + age + " old"
                      : "it is " + age + " old, allowed " + numberOf(config_.timeout, "s") + " (timeout)");
  }
  if (since_.isZero())
    return measured_->topic + ": " + (distrust_.empty() ? "nothing has come; does your node run?" : distrust_);
  if (secondsBetween(since_, now) < kWindow)
    return measured_->topic + ": its rate is being measured" + (before_.empty() ? "" : ", after: " + before_);
  if (const double rate = this->rate(now); rate < kLeastShare * config_.rate)
    return measured_->topic + " comes at " + numberOf(rate, "Hz") + ", told are " + numberOf(config_.rate, "Hz (rate)");
  trusted_ = true;
  return "";
}

/// Why it does not move; empty: it would.
std::string ExternalManipulator::nodeReason(const ros::Time& now) const {
  if (node_.state.empty()) return state_input_.topic + ": nothing has come";
  if (const std::string rivals = state_input_.rivals(now); !rivals.empty())
    return state_input_.topic + " is sent by two nodes, " + rivals;
  if (node_.state != toText(OperatingState::kEnabled)) return config_.name_space + " is " + node_.state;
  return node_.is_homed ? "" : config_.name_space + " is not homed";
}

/// Hz, in the last kWindow.
double ExternalManipulator::rate(const ros::Time& now) const {
  const auto recent = std::count_if(readings_.begin(), readings_.end(), [&](const Measured& reading) {
    return secondsBetween(reading.time, now) <= kWindow;
  });
  return static_cast<double>(recent) / kWindow;
}

/// m/s, from readings that are kRest apart.
Eigen::Vector3d ExternalManipulator::velocity() const {
  for (auto before = readings_.rbegin(); before != readings_.rend(); ++before) {
    const double between = secondsBetween(before->time, last_->time);
    if (between < kRest) continue;
    const Eigen::Vector3d largest = geometry_.velocities();
    return ((last_->joints - before->joints) / between).cwiseMax(-largest).cwiseMin(largest);
  }
  return Eigen::Vector3d::Zero();
}

std::optional<ManipulatorDevice::Reading> ExternalManipulator::reading() const {
  if (!trusted_ || displaced_) return std::nullopt;
  const Eigen::Vector3d velocity = this->velocity();
  const double age = std::clamp(secondsBetween(last_->time, now()), 0.0, 2 / config_.rate);
  return Reading{last_->joints + age * velocity, velocity};
}

// What it is told

void ExternalManipulator::follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) {
  if (state() != State::kReady || !joints.allFinite() || !velocity.allFinite()) return;
  if (!goal_) path_.add(now().toSec(), geometry_.tip(last_->joints));
  goal_ = Goal{{joints, velocity}, std::nullopt, 0, now()};
}

/// By set-points along the line, as for any node that follows.
void ExternalManipulator::moveTo(const Eigen::Vector3d& joints, double speed) {
  if (state() != State::kReady || !joints.allFinite() || !(speed > 0)) return;
  if (!goal_) follow(last_->joints, Eigen::Vector3d::Zero());
  goal_->end = joints;
  goal_->speed = speed;
}

void ExternalManipulator::hold() {
  goal_ = Goal{{last_->joints, Eigen::Vector3d::Zero()}, std::nullopt, 0, now()};
  send(now());
}

void ExternalManipulator::stop() {
  if (state() == State::kReady) hold();
}

/// Nothing is pursued any more. A node that would still move is told to stay.
void ExternalManipulator::release() {
  const bool obeys = node_.state == toText(OperatingState::kEnabled) && !since_.isZero() && !displaced_;
  if (goal_ && obeys) hold();
  if (goal_) coasts_to_ = sent_position_;
  goal_.reset();
  path_.clear();
  ready_ = false;
}

void ExternalManipulator::raiseFault(const std::string& reason) {
  if (fault_.empty()) fault_ = config_.name_space + ": " + reason;
  release();
}

void ExternalManipulator::clearFault() {
  fault_.clear();
  displaced_ = false;
  if (node_.state.empty() || node_.state == toText(OperatingState::kEnabled)) return;
  StringStamped word;
  word.header.stamp = asked_ = now();
  word.string = toText(node_.state == toText(OperatingState::kPaused) ? StateCommand::kResume : StateCommand::kEnable);
  words_.publish(word);
}

void ExternalManipulator::advance(double dt) {
  if (!goal_->end || dt <= 0) return;
  AxesMotion& setpoint = goal_->setpoint;
  setpoint.velocity = straightVelocity(geometry_, setpoint, *goal_->end, goal_->speed, dt);
  setpoint.position += setpoint.velocity * dt;
  if (atRest(geometry_, setpoint, *goal_->end, dt)) {
    setpoint = {*goal_->end, Eigen::Vector3d::Zero()};
    goal_->end.reset();
  }
  goal_->commanded = now();
}

void ExternalManipulator::send(const ros::Time& now) {
  const AxesMotion& setpoint = goal_->setpoint;
  sent_ = now;
  sent_position_ = setpoint.position;
  path_.add(now.toSec(), geometry_.tip(setpoint.position));
  const Eigen::Vector3d of_device = config_.axes.toDevice(setpoint.position);
  if (config_.joints_told) {
    const Eigen::Vector3d velocity = config_.axes.directions.cwiseProduct(setpoint.velocity);
    JointState message;
    message.header.stamp = now;
    message.name = config_.joints;
    message.position.assign(of_device.data(), of_device.data() + 3);
    message.velocity.assign(velocity.data(), velocity.data() + 3);
    return joint_commands_.publish(message);
  }
  PoseStamped message = toPose(config_.inWorld() ? geometry_.tip(setpoint.position) : of_device, now, config_.frame);
  message.pose.orientation = orientation_;
  pose_commands_.publish(message);
}

void ExternalManipulator::step(double) {
  const ros::Time now = this->now();
  const double dt = stepped_.isZero() ? 0 : secondsBetween(stepped_, now);
  stepped_ = now;
  if (dt < 0) {
    distrust("the clock was set back");
    last_.reset();
  }
  reason_ = positionsReason(now);
  if (reason_.empty()) reason_ = nodeReason(now);
  if (!reason_.empty() || !fault_.empty()) return release();
  if (!ready_) {
    ready_ = true;
    coasts_to_.reset();
    hold();  // no set-point of before is pursued
  }
  if (!goal_) return;
  advance(dt);
  if (isDue(sent_, now, 1 / config_.rate)) send(now);
  if (secondsBetween(goal_->commanded, now) <= kStreamEnds || moving()) return;
  goal_.reset();
  path_.clear();
}

// What it is

ManipulatorAbilities ExternalManipulator::abilities() const {
  ManipulatorAbilities abilities;
  abilities.device = "external, " + config_.name_space;
  abilities.follows = true;
  abilities.command_interval = abilities.reading_interval = 1 / config_.rate;
  abilities.resolution = config_.resolution;
  abilities.speed = geometry_.velocities().maxCoeff();
  abilities.latency = config_.lag;
  abilities.stop_time = 2 * config_.lag + brakingTime(geometry_, geometry_.velocities());
  return abilities;
}

ManipulatorDevice::State ExternalManipulator::state() const {
  if (!trusted_) return State::kDisconnected;
  if (!fault_.empty() || node_.state == toText(OperatingState::kFault)) return State::kFault;
  return ready_ ? State::kReady : State::kDisconnected;
}

std::string ExternalManipulator::reason() const {
  switch (state()) {
    case State::kReady:
      return "";
    case State::kFault:
      return fault_.empty() ? config_.name_space + ": it is in FAULT" : fault_;
    default:
      return reason_;
  }
}

std::string ExternalManipulator::note() const {
  if (!goal_ || secondsBetween(goal_->commanded, now()) < config_.lag + kUnreached || !moving()) return "";
  return "it rests " + micrometres((goal_->setpoint.position - last_->joints).norm()) +
         " beside its set-point; resolution = " + micrometres(config_.resolution);
}

bool ExternalManipulator::moving() const {
  if (!goal_ || !last_) return false;
  const AxesMotion& setpoint = goal_->setpoint;
  if (goal_->end || !setpoint.velocity.isZero(0) || sent_position_ != setpoint.position) return true;
  const bool there = (setpoint.position - last_->joints).cwiseAbs().maxCoeff() <= 1.5 * config_.resolution;
  return !there || velocity().cwiseAbs().maxCoeff() * kRest > config_.resolution;
}

void ExternalManipulator::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const bool late = largest_lag_ > config_.lag;
  if (state() != State::kReady) {
    status.summary(DiagnosticStatus::WARN, reason());
  } else if (late) {
    status.summary(DiagnosticStatus::WARN,
                   "it is " + numberOf(largest_lag_, "s") + " late, told are " + numberOf(config_.lag, "s (lag)"));
  } else {
    status.summary(DiagnosticStatus::OK, "it keeps the rate and the lag that were told");
  }
  status.add("rate of its positions (Hz)", rate(now()));
  status.add("rate that was told (Hz)", config_.rate);
  status.add("largest lag since the last report (s)", largest_lag_);
  status.add("lag that was told (s)", config_.lag);
  status.add("age of a position at its arrival (s)", age_);
  status.add("its operating state", node_.state);
  largest_lag_ = 0;
}

}  // namespace microinjection
