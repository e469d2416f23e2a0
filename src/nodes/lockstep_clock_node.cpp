#include "nodes/lockstep_clock_node.h"

#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include <algorithm>

#include "base/errors.h"
#include "nodes/runtime/lockstep.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kLongestCountedWait = 0.2;  // s, largest counted part of a wait

}  // namespace

const char* const LockstepClockNode::kHelp =
    "lockstep_clock: steps /clock when every node of /lockstep/participants has acknowledged the last tick.\n"
    "Parameters: /lockstep/participants (names of nodes) and\n"
    "  ~step              s, of one tick, default 0.001\n"
    "  ~real_time_factor  largest speed, times real time; default 0: as fast as possible\n"
    "  ~warn_after        s of wall time without an acknowledgement until a warning, default 5\n"
    "  ~frozen_after      s of wall time without an acknowledgement until a node leaves, default 60\n";

LockstepClockNode::LockstepClockNode(Bus& bus)
    : bus_(dynamic_cast<RosBus&>(bus)), participants_(lockstepParticipants()) {
  ConfigReader reader = parameterReader(bus);
  reader.number("step", step_, Range::closed(1e-6, 1));
  reader.number("real_time_factor", real_time_factor_, Range::nonNegative());
  reader.number("warn_after", warn_after_, Range::positive());
  reader.number("frozen_after", frozen_after_, Range::positive());
  reader.finish();
  if (participants_.empty()) throw ConfigError("/lockstep/participants must be a list of at least one node's name");
  missing_ = participants_;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue_);
  departed_ = node.advertise<std_msgs::String>(kLeftTopic, 10, true);
  clock_ = node.advertise<rosgraph_msgs::Clock>(
      "/clock", 10, {},
      [this](const ros::SingleSubscriberPublisher& subscriber) { leave(subscriber.getSubscriberName(), "has ended"); },
      {}, true);
  acknowledgements_ = node.subscribe(kAcknowledgementTopic, 100, &LockstepClockNode::onAcknowledgement, this,
                                     ros::TransportHints().tcpNoDelay());
  using Name = ros::MessageEvent<const std_msgs::String>;
  leave_ = node.subscribe<std_msgs::String, const Name&>(
      kLeaveTopic, 10,
      [this](const Name& name) {
        leave(name.getConstMessage()->data, "is frozen, reported by " + name.getPublisherName());
      },
      {}, ros::TransportHints().tcpNoDelay());
  bus_.runInstead([this] { run(); });
}

void LockstepClockNode::onAcknowledgement(const std_msgs::HeaderConstPtr& header) {
  if (header->stamp == tick_) missing_.erase(header->frame_id);
}

void LockstepClockNode::leave(const std::string& name, const std::string& reason) {
  if (participants_.erase(name) == 0) return;
  missing_.erase(name);
  ROS_WARN_STREAM(name << " has left the lock step at " << tick_ << " s; it " << reason
                       << "; time continues without it");
  std_msgs::String message;
  message.data = departed_published_ += name + " ";
  departed_.publish(message);
}

std::string LockstepClockNode::missingNames() const {
  std::string names;
  for (const std::string& name : missing_) names += " " + name;
  return names;
}

void LockstepClockNode::waitForAll() {
  ros::SteadyTime before = ros::SteadyTime::now(), warned = before;
  double waiting_time = 0;  // s, without times in which this node itself was frozen
  while (bus_.shouldContinue() && !missing_.empty()) {
    queue_.callAvailable(ros::WallDuration(0.1));
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (secondsBetween(warned, now) >= warn_after_) {
      warned = now;
      ROS_WARN_STREAM("the clock stands at " << tick_ << " s and waits for:" << missingNames());
    }
    waiting_time += std::min(secondsBetween(before, now), kLongestCountedWait);
    before = now;
    if (tick_.isZero() || waiting_time < frozen_after_) continue;
    for (const std::string& name : std::set<std::string>(missing_)) leave(name, "does not acknowledge");
  }
}

void LockstepClockNode::pace(const ros::SteadyTime& began) const {
  if (real_time_factor_ <= 0) return;
  const double due = tick_.toSec() / real_time_factor_;
  const double ahead = due - secondsBetween(began, ros::SteadyTime::now());
  if (ahead > 0) ros::WallDuration(ahead).sleep();
}

void LockstepClockNode::run() {
  waitForAll();
  const ros::SteadyTime began = ros::SteadyTime::now();
  while (bus_.shouldContinue() && !participants_.empty()) {
    tick_ += ros::Duration(step_);
    missing_ = participants_;
    rosgraph_msgs::Clock message;
    message.clock = tick_;
    clock_.publish(message);
    waitForAll();
    pace(began);
  }
}

}  // namespace microinjection
