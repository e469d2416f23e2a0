#pragma once

#include <ros/ros.h>

#include <string>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/OperatingState.h"
#include "diagnostic_msgs/DiagnosticArray.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// What the operator of a hand without a device wants to see beside it: the controller's state, where the injection is,
/// and why the needle does not follow. For people, not for control.
class SessionState {
 public:
  explicit SessionState(Cycle& cycle);

  /// For example "ENABLED, indent, 0.52 uN, 12.3 um deep" or "no controller".
  std::string text() const;
  /// What bridge and controller say of themselves, for example "needle held: clutch is pressed"; once a second.
  std::string held() const;
  /// What became of the operator's last word, where that was not done; else empty.
  const std::string& notice() const { return notice_; }

 private:
  void process(const diagnostic_msgs::DiagnosticArray& diagnostics);

  ros::Subscriber controller_, injection_, diagnostics_;
  std::string state_ = "no controller";
  std::string injection_text_;
  std::string held_, far_, notice_;
};

}  // namespace microinjection
