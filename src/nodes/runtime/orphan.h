#pragma once

#include <ros/ros.h>

#include "nodes/runtime/master_monitor.h"

namespace microinjection {

/// Ends a node without a Cycle when the ROS master has been away for too long, see MasterMonitor.
/// Call it regularly.
inline void endIfOrphaned(const MasterMonitor& master) {
  if (!master.masterLostForLong()) return;
  ROS_ERROR("the ROS master has been away for too long: this node ends");
  ros::requestShutdown();
}

}  // namespace microinjection
