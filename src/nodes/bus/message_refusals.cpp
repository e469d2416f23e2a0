#include "nodes/bus/message_refusals.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/console.h>

namespace microinjection {

void MessageRefusals::add(const std::string& topic, const std::string& reason) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Topic& entry = topics_[topic];
    ++entry.count;
    entry.reason = reason;
  }
  ROS_WARN_STREAM_THROTTLE(1, "a message on " << topic << " is refused: " << reason);
}

void MessageRefusals::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [topic, entry] : topics_) {
    status.add("messages refused on " + topic, entry.count);
    if (entry.count > entry.reported) {
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, topic + ": refused, " + entry.reason);
    }
    entry.reported = entry.count;
  }
}

}  // namespace microinjection
