#include "nodes/runtime/lockstep.h"

#include <ros/ros.h>

#include <vector>

namespace microinjection {

std::set<std::string> lockstepParticipants() {
  std::vector<std::string> names;
  ros::param::get("/lockstep/participants", names);
  return std::set<std::string>(names.begin(), names.end());
}

bool takesPartInLockstep() { return lockstepParticipants().count(ros::this_node::getName()) > 0; }

}  // namespace microinjection
