#include "nodes/runtime/cycle.h"

#include <std_msgs/String.h>

#include <algorithm>

#include "nodes/runtime/lockstep.h"

namespace microinjection {
namespace {

constexpr double kWarnPeriod = 5;  // s

}  // namespace

Cycle::Cycle(const ros::NodeHandle& node, double rate)
    : period_(1 / rate),
      lockstep_(takesPartInLockstep()),
      node_(node),
      sampled_node_(node),
      diagnostics_(rate),
      master_(!lockstep_) {
  node_.setCallbackQueue(&queue_);
  sampled_node_.setCallbackQueue(&sampled_queue_);
}

bool Cycle::shouldContinue() {
  if (master_.masterLostForLong() && !busy_) {
    ROS_ERROR("the ROS master has been away for too long, and nothing moves: this node ends");
    stopped_ = true;
  }
  if (lockstep_ && hasDeparted(ros::this_node::getName())) {
    ROS_ERROR("the lock step goes on without this node, which was frozen: it ends");
    stopped_ = true;
  }
  return ros::ok() && !stopped_;
}

void Cycle::run(const std::function<void(const Tick&)>& step) {
  step_ = step;
  // The first line of a node's log waits for a parameter of rosout from the master, so log it
  // before stepping.
  ROS_INFO_STREAM("steps " << (lockstep_ ? "in lock step" : "live") << ", nominally each " << period_ << " s");
  if (lockstep_) {
    runLockstep();
  } else {
    runLive();
  }
}

void Cycle::step(const ros::Time& now) {
  sampled_queue_.callAvailable();
  stalls_.step(now);
  if (now.isZero()) return;  // the simulated clock has not started
  if (now < last_step_) {    // the clock was set back: all received messages are invalid
    for (auto& input : inputs_) input->invalidate();
    last_step_ = now;
  }
  const double dt = last_step_.isZero() ? period_ : secondsBetween(last_step_, now);
  if (dt <= 0) return;  // the simulated clock stands still
  checkMaster();
  diagnostics_.beginStep();
  step_({now, std::min(dt, 10 * period_)});
  diagnostics_.endStep(now);
  last_step_ = now;
}

void Cycle::checkMaster() {
  const bool lost = master_.lost();
  if (lost == master_lost_) return;
  master_lost_ = lost;
  for (auto& input : inputs_) input->disconnected = lost;
  if (lost) {
    ROS_ERROR("the ROS master is lost, or a new one that does not know this node: no input counts");
  } else {
    ROS_INFO("the ROS master is back");
  }
}

void Cycle::runLive() {
  const bool driven = std::any_of(inputs_.begin(), inputs_.end(),
                                  [](const auto& input) { return input->phase == InputPhase::kThisTick; });
  ros::SteadyTime deadline = ros::SteadyTime::now();
  while (shouldContinue()) {
    const ros::WallDuration wait(secondsBetween(ros::SteadyTime::now(), deadline));
    queue_.callAvailable(std::clamp(wait, ros::WallDuration(0), ros::WallDuration(0.1)));
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (!triggered_ && now < deadline) continue;
    // The node does not wait for an input that is late by half a period.
    deadline =
        driven ? now + ros::WallDuration((triggered_ ? 1.5 : 1.0) * period_) : deadline + ros::WallDuration(period_);
    if (secondsBetween(deadline, now) > 10 * period_) deadline = now;  // after a stall: do not catch up
    triggered_ = false;
    step(ros::Time::now());
  }
}

bool Cycle::hasInputOf(InputPhase phase, const ros::Time& stamp) const {
  return std::all_of(inputs_.begin(), inputs_.end(), [&](const auto& input) {
    return input->phase != phase || hasDeparted(input->publisher_name) || input->hasInputOf(stamp);
  });
}

bool Cycle::readyFor(const ros::Time& tick) const {
  const bool first = stepped_tick_.isZero();  // nothing was published before it
  return hasInputOf(InputPhase::kThisTick, tick) && (first || hasInputOf(InputPhase::kPreviousTick, stepped_tick_));
}

std::string Cycle::inputsWithoutPublisher() const {
  std::string topics;
  for (const auto& input : inputs_) {
    if (input->publisher_name.empty()) topics += " " + input->topic;
  }
  return topics;
}

bool Cycle::hasDeparted(const std::string& participant) const {
  return !departed_.empty() && (' ' + departed_).find(' ' + participant + ' ') != std::string::npos;
}

void Cycle::runLockstep() {
  const ros::Subscriber clock = node_.subscribe<rosgraph_msgs::Clock>(
      "/clock", 10, [this](const rosgraph_msgs::ClockConstPtr& message) { tick_ = message->clock; }, {},
      ros::TransportHints().tcpNoDelay());
  const ros::Subscriber left = node_.subscribe<std_msgs::String>(
      kLeftTopic, 10, [this](const std_msgs::StringConstPtr& message) { departed_ = message->data; });
  acknowledgement_ = node_.advertise<std_msgs::Header>(kAcknowledgementTopic, 10, true);
  for (auto& output : outputs_) output->announce();
  ros::SteadyTime warned = ros::SteadyTime::now();
  std::string missing;
  while (shouldContinue() && !(missing = inputsWithoutPublisher()).empty()) {
    queue_.callAvailable(ros::WallDuration(0.1));
    if (secondsBetween(warned, ros::SteadyTime::now()) < kWarnPeriod) continue;
    warned = ros::SteadyTime::now();
    ROS_WARN_STREAM("waits for the publishers of:" << missing);
  }
  acknowledge(ros::Time());  // ready for the first tick
  while (shouldContinue()) {
    queue_.callAvailable(ros::WallDuration(0.1));
    if (tick_ == stepped_tick_ || !readyFor(tick_)) continue;
    const ros::Time now = tick_;
    const bool first = stepped_tick_.isZero();
    for (auto& input : inputs_) {
      runGuarded(input->topic,
                 [&] { input->receiveTick(input->phase == InputPhase::kThisTick ? now : stepped_tick_, now); });
    }
    for (auto& output : outputs_) output->beginTick(now);
    step(now);
    for (auto& output : outputs_) output->endTick();
    stepped_tick_ = now;
    // A topic may connect later than its greeting. The acknowledgement waits until this node has
    // the first message or silence of each input: publishers latch only the newest.
    while (first && shouldContinue() && !hasInputOf(InputPhase::kPreviousTick, now))
      queue_.callAvailable(ros::WallDuration(0.1));
    acknowledge(now);
  }
}

void Cycle::acknowledge(const ros::Time& now) {
  std_msgs::Header header;
  header.stamp = now;
  header.frame_id = ros::this_node::getName();
  acknowledgement_.publish(header);
}

}  // namespace microinjection
