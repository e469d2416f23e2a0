#pragma once

#include <ros/ros.h>

#include <string>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/OperatingState.h"
#include "diagnostic_msgs/DiagnosticArray.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// State of the session for the display beside a hand without a device: the controller's state, the
/// injection's state, and why the needle does not follow. For people, not for control.
class SessionState {
 public:
  explicit SessionState(Cycle& cycle);

  /// For example "ENABLED, indent, 0.52 uN, 12.3 um deep" or "no controller".
  std::string text() const;
  /// The diagnostics of bridge and controller, for example "needle held: clutch is pressed"; once a
  /// second.
  std::string held() const;
  /// Why the operator's last command was not executed; else empty.
  const std::string& notice() const { return notice_; }

 private:
  void process(const diagnostic_msgs::DiagnosticArray& diagnostics);

  ros::Subscriber controller_, injection_, diagnostics_;
  std::string state_ = "no controller";
  std::string injection_text_;
  std::string held_, follower_, notice_;
};

}  // namespace microinjection
