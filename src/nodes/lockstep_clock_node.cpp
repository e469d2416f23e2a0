#include "nodes/lockstep_clock_node.h"

#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include "base/errors.h"
#include "nodes/lockstep.h"
#include "nodes/node_parameters.h"
#include "nodes/stamps.h"

namespace microinjection {

const char* const LockstepClockNode::kHelp =
    "lockstep_clock: steps /clock when every node of /lockstep/participants has done the tick before.\n"
    "Parameters: ~step (s), ~real_time_factor (0: as fast as it goes), ~warn_after (s).\n";

LockstepClockNode::LockstepClockNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : participants_(lockstepParticipants()) {
  ConfigReader reader = parameterReader(private_node);
  reader.number("step", step_, Range::closed(1e-6, 1));
  reader.number("real_time_factor", real_time_factor_, Range::nonNegative());
  reader.number("warn_after", warn_after_, Range::positive());
  reader.finish();
  if (participants_.empty()) throw ConfigError("/lockstep/participants must be a list of at least one node's name");
  missing_ = participants_;
  node.setCallbackQueue(&queue_);
  left_ = node.advertise<std_msgs::String>(kLeftTopic, 10, true);
  clock_ = node.advertise<rosgraph_msgs::Clock>(
      "/clock", 10, {}, [this](const ros::SingleSubscriberPublisher& who) { onLeaving(who.getSubscriberName()); }, {},
      true);
  acknowledgements_ = node.subscribe(kAcknowledgementTopic, 100, &LockstepClockNode::onAcknowledgement, this,
                                     ros::TransportHints().tcpNoDelay());
}

void LockstepClockNode::onAcknowledgement(const std_msgs::HeaderConstPtr& header) {
  if (header->stamp == tick_) missing_.erase(header->frame_id);
}

void LockstepClockNode::onLeaving(const std::string& name) {
  if (participants_.erase(name) == 0) return;
  missing_.erase(name);
  ROS_WARN_STREAM(name << " has left the lock step at " << tick_ << " s; time goes on without it");
  std_msgs::String message;
  message.data = said_left_ += name + " ";
  left_.publish(message);
}

bool LockstepClockNode::goesOn() const { return ros::ok() && !master_.orphaned(); }

void LockstepClockNode::waitForAll() {
  ros::SteadyTime warned = ros::SteadyTime::now();
  while (goesOn() && !missing_.empty()) {
    queue_.callAvailable(ros::WallDuration(0.1));
    if (secondsBetween(warned, ros::SteadyTime::now()) < warn_after_) continue;
    warned = ros::SteadyTime::now();
    std::string names;
    for (const std::string& name : missing_) names += " " + name;
    ROS_WARN_STREAM("the clock stands at " << tick_ << " s and waits for:" << names);
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
  while (goesOn() && !participants_.empty()) {
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
