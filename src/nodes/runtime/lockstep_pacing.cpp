#include "nodes/runtime/lockstep_pacing.h"

#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include <algorithm>

#include "nodes/runtime/lockstep.h"

namespace microinjection {
namespace {

constexpr double kWarnPeriod = 5;      // s
constexpr double kGreetingPeriod = 1;  // s
const ros::WallDuration kWait(0.1);

}  // namespace

bool LockstepPacing::hasInputOf(InputPhase phase, const ros::Time& stamp) const {
  return std::all_of(ports_.inputs.begin(), ports_.inputs.end(), [&](const auto& input) {
    return input->phase != phase || hasDeparted(input->publisher_name) || input->hasInputOf(stamp);
  });
}

bool LockstepPacing::isReady() const {
  const bool first = stepped_tick_.isZero();  // nothing was published before it
  return tick_ != stepped_tick_ && hasInputOf(InputPhase::kThisTick, tick_) &&
         (first || hasInputOf(InputPhase::kPreviousTick, stepped_tick_));
}

std::string LockstepPacing::inputsWithoutPublisher() const {
  std::string topics;
  for (const auto& input : ports_.inputs) {
    if (input->publisher_name.empty()) topics += " " + input->topic;
  }
  return topics;
}

bool LockstepPacing::hasDeparted(const std::string& participant) const {
  return !departed_.empty() && (' ' + departed_).find(' ' + participant + ' ') != std::string::npos;
}

void LockstepPacing::run(const CycleSteps& steps) {
  const ros::Subscriber clock = ports_.node.subscribe<rosgraph_msgs::Clock>(
      "/clock", 10, [this](const rosgraph_msgs::ClockConstPtr& message) { tick_ = message->clock; }, {},
      ros::TransportHints().tcpNoDelay());
  const ros::Subscriber left = ports_.node.subscribe<std_msgs::String>(
      kLeftTopic, 10, [this](const std_msgs::StringConstPtr& message) { departed_ = message->data; });
  acknowledgement_ = ports_.node.advertise<std_msgs::Header>(kAcknowledgementTopic, 10, true);
  greet(false);
  waitForPublishers(steps);
  ROS_INFO("ready for the first tick");
  greet(true);
  while (steps.should_continue()) {
    ports_.queue.callAvailable(kWait);
    if (isReady()) stepTick(steps);
    if (tick_.isZero()) greetAgain(true);
  }
}

void LockstepPacing::greet(bool ready) {
  for (auto& output : ports_.outputs) output->announce();
  if (ready) acknowledge(ros::Time());
  greeted_ = ros::SteadyTime::now();
}

void LockstepPacing::greetAgain(bool ready) {
  if (secondsBetween(greeted_, ros::SteadyTime::now()) >= kGreetingPeriod) greet(ready);
}

void LockstepPacing::waitForPublishers(const CycleSteps& steps) {
  ros::SteadyTime warned = ros::SteadyTime::now();
  std::string missing;
  while (steps.should_continue() && !(missing = inputsWithoutPublisher()).empty()) {
    ports_.queue.callAvailable(kWait);
    greetAgain(false);
    if (secondsBetween(warned, ros::SteadyTime::now()) < kWarnPeriod) continue;
    warned = ros::SteadyTime::now();
    ROS_WARN_STREAM("waits for the publishers of:" << missing);
  }
}

void LockstepPacing::stepTick(const CycleSteps& steps) {
  const ros::Time now = tick_, before = stepped_tick_;
  for (auto& input : ports_.inputs) {
    runGuarded(input->topic, [&] { input->receiveTick(input->phase == InputPhase::kThisTick ? now : before, now); });
  }
  for (auto& output : ports_.outputs) output->beginTick(now);
  steps.step(now);
  for (auto& output : ports_.outputs) output->endTick();
  stepped_tick_ = now;
  // A topic may connect later than its greeting. The acknowledgement waits until this node has the
  // first message or silence of each input: publishers latch only the newest.
  while (before.isZero() && steps.should_continue() && !hasInputOf(InputPhase::kPreviousTick, now))
    ports_.queue.callAvailable(kWait);
  acknowledge(now);
}

void LockstepPacing::acknowledge(const ros::Time& now) {
  std_msgs::Header header;
  header.stamp = now;
  header.frame_id = ros::this_node::getName();
  acknowledgement_.publish(header);
}

}  // namespace microinjection
