#include "nodes/runtime/lockstep_pacing.h"

#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <utility>

#include "nodes/runtime/lockstep.h"

namespace microinjection {
namespace {

constexpr double kWarnPeriod = 5;      // s
constexpr double kGreetingPeriod = 1;  // s
constexpr double kWait = 0.1;          // s

}  // namespace

bool LockstepPacing::hasInputOf(bool of_this_tick, const ros::Time& stamp) const {
  return std::all_of(ports_.inputs.begin(), ports_.inputs.end(), [&](const auto& input) {
    return (input->phase == InputPhase::kDrives) != of_this_tick || hasDeparted(input->publisher_name) ||
           input->hasInputOf(stamp);
  });
}

bool LockstepPacing::isReady() const {
  const bool first = stepped_tick_.isZero();  // nothing was published before it
  return tick_ != stepped_tick_ && hasInputOf(true, tick_) && (first || hasInputOf(false, stepped_tick_));
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

LockstepPacing::LockstepPacing(CyclePorts& ports, Bus& bus) : ports_(ports), bus_(dynamic_cast<RosBus&>(bus)) {}

void LockstepPacing::takeOver(std::function<void(const ros::Time&)> step) {
  step_ = std::move(step);
  bus_.runInstead([this] { run(); });
}

bool LockstepPacing::shouldContinue() const {
  if (hasLeft()) ROS_ERROR("the lock step goes on without this node, which was frozen: it ends");
  return bus_.shouldContinue() && !hasLeft();
}

void LockstepPacing::run() {
  const Subscription clock = bus_.subscribe<rosgraph_msgs::Clock>(
      "/clock", 10, [this](const Delivery<rosgraph_msgs::Clock>& delivery) { tick_ = delivery.message->clock; },
      Serving::kDrives);
  const Subscription left = bus_.subscribe<std_msgs::String>(
      kLeftTopic, 10, [this](const Delivery<std_msgs::String>& delivery) { departed_ = delivery.message->data; },
      Serving::kDrives);
  acknowledgement_ = bus_.advertise<std_msgs::Header>(kAcknowledgementTopic, 10, true);
  greet(false);
  waitForPublishers();
  ROS_INFO("ready for the first tick");
  greet(true);
  while (shouldContinue()) {
    bus_.serveWaking(kWait);
    if (isReady()) stepTick();
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

void LockstepPacing::waitForPublishers() {
  ros::SteadyTime warned = ros::SteadyTime::now();
  std::string missing;
  while (shouldContinue() && !(missing = inputsWithoutPublisher()).empty()) {
    bus_.serveWaking(kWait);
    greetAgain(false);
    if (secondsBetween(warned, ros::SteadyTime::now()) < kWarnPeriod) continue;
    warned = ros::SteadyTime::now();
    ROS_WARN_STREAM("waits for the publishers of:" << missing);
  }
}

void LockstepPacing::stepTick() {
  const ros::Time now = tick_, before = stepped_tick_;
  for (auto& input : ports_.inputs) {
    runGuarded(bus_.refusals(), input->topic,
               [&] { input->receiveTick(input->phase == InputPhase::kDrives ? now : before, now); });
  }
  for (auto& output : ports_.outputs) output->beginTick(now);
  bus_.serveSampled();
  step_(now);
  for (auto& output : ports_.outputs) output->endTick();
  stepped_tick_ = now;
  // A topic may connect later than its greeting. The acknowledgement waits until this node has the
  // first message or silence of each input: publishers latch only the newest.
  while (before.isZero() && shouldContinue() && !hasInputOf(false, now)) bus_.serveWaking(kWait);
  acknowledge(now);
}

void LockstepPacing::acknowledge(const ros::Time& now) {
  std_msgs::Header header;
  header.stamp = now;
  header.frame_id = bus_.name();
  acknowledgement_.publish(header);
}

}  // namespace microinjection
