#include "nodes/runtime/command_log.h"

#include <ros/ros.h>

#include <utility>

namespace microinjection {

void CommandLog::answered(const std::string& command, const std::string& refusal) {
  refusal_ = refusal.empty() ? "" : command + " refused: " + refusal;
  if (refusal_.empty()) return;
  ++refused_;
  refused_news_ = refusal_;
  // A stream that is refused says the same a thousand times a second.
  const double now = ros::SteadyTime::now().toSec();
  if (refusal_ == logged_ && now - logged_at_ < 1) return;
  logged_ = refusal_;
  logged_at_ = now;
  ROS_WARN_STREAM(refusal_);
}

void CommandLog::overridden(const std::string& motion, const std::string& why) {
  ++overridden_;
  overridden_news_ = motion + " overridden: " + why;
  ROS_WARN_STREAM(overridden_news_);
}

std::string CommandLog::takeUpdates() {
  std::string news = std::exchange(refused_news_, refusal_);
  const std::string overridden = std::exchange(overridden_news_, "");
  if (!overridden.empty()) news += (news.empty() ? "" : "; ") + overridden;
  return news;
}

void CommandLog::addCounts(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("commands refused", refused_);
  status.add("motions overridden", overridden_);
}

}  // namespace microinjection
