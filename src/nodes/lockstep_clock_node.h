#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <set>
#include <string>

#include "nodes/bus/ros_bus.h"

namespace microinjection {

/// Steps /clock when every participant of the lock step has acknowledged the last tick. The same
/// session then gives the same bits on any machine, faster or slower than real time. A participant
/// leaves for good
/// - when it no longer subscribes to /clock, since it ended or was killed,
/// - when it is frozen: no acknowledgement for `frozen_after`, or named on /lockstep/leave.
///
/// Time then continues without it, and the others' time-outs run. When all have left, this node
/// ends. It needs a RosBus, and uses roscpp, which reports subscribers that leave.
///
/// In:  /lockstep/acknowledgement (std_msgs/Header of each participant), /lockstep/leave
///      (std_msgs/String)
/// Out: /clock (rosgraph_msgs/Clock), /lockstep/left (std_msgs/String, see lockstep.h)
///
/// Parameters: see kHelp
class LockstepClockNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range, or there are no participants.
  explicit LockstepClockNode(Bus& bus);

 private:
  void run();
  void onAcknowledgement(const std_msgs::HeaderConstPtr& header);
  void leave(const std::string& name, const std::string& reason);
  std::string missingNames() const;
  void waitForAll();
  void pace(const ros::SteadyTime& began) const;

  RosBus& bus_;
  double step_ = 1e-3;           ///< s
  double real_time_factor_ = 0;  ///< 0: as fast as possible
  double warn_after_ = 5;        ///< s of wall time
  double frozen_after_ = 60;     ///< s of wall time
  std::set<std::string> participants_;
  std::set<std::string> missing_;  ///< participants without an acknowledgement of the present tick
  ros::Time tick_;
  ros::CallbackQueue queue_;
  ros::Publisher clock_;
  ros::Publisher departed_;
  std::string departed_published_;
  ros::Subscriber acknowledgements_, leave_;
};

}  // namespace microinjection
