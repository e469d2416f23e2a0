#include "nodes/runtime/command_log.h"

#include <ros/console.h>

#include <utility>

namespace microinjection {

void CommandLog::addResult(const std::string& command, const std::string& refusal) {
  refusal_ = refusal.empty() ? "" : command + " refused: " + refusal;
  if (refusal_.empty()) return;
  ++refused_;
  new_refusal_ = refusal_;
  // A refused stream would log the same line a thousand times a second.
  const double now = bus_.steady().toSec();
  if (refusal_ == logged_ && now - logged_at_ < 1) return;
  logged_ = refusal_;
  logged_at_ = now;
  ROS_WARN_STREAM(refusal_);
}

void CommandLog::addOverride(const std::string& motion, const std::string& reason) {
  ++overridden_;
  new_override_ = motion + " overridden: " + reason;
  ROS_WARN_STREAM(new_override_);
}

std::string CommandLog::takeUpdates() {
  std::string updates = std::exchange(new_refusal_, refusal_);
  const std::string overridden = std::exchange(new_override_, "");
  if (!overridden.empty()) updates += (updates.empty() ? "" : "; ") + overridden;
  return updates;
}

void CommandLog::addCounts(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("commands refused", refused_);
  status.add("motions overridden", overridden_);
}

}  // namespace microinjection
