#include "rviz/task_runner.h"

namespace microinjection {

using actionlib_msgs::GoalStatus;

std::string endText(const GoalStatus& status) {
  const auto word = [&status] {
    switch (status.status) {
      case GoalStatus::PREEMPTED:
        return "PREEMPTED";
      case GoalStatus::SUCCEEDED:
        return "SUCCEEDED";
      case GoalStatus::ABORTED:
        return "ABORTED";
      case GoalStatus::REJECTED:
        return "REJECTED";
      case GoalStatus::RECALLED:
        return "RECALLED";
      default:
        return "LOST";
    }
  };
  return std::string(word()) + " " + status.text;
}

bool isOver(const GoalStatus& status) {
  switch (status.status) {
    case GoalStatus::PENDING:
    case GoalStatus::ACTIVE:
    case GoalStatus::PREEMPTING:
    case GoalStatus::RECALLING:
      return false;
    default:
      return true;
  }
}

}  // namespace microinjection
