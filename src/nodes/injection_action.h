#pragma once

#include <actionlib/server/simple_action_server.h>
#include <ros/ros.h>

#include "cell_microinjection/InjectAction.h"
#include "control/injection_controller.h"

namespace microinjection {

/// The action /controller/inject (Inject.action) before an InjectionController. It has no thread: its messages are
/// heard where the node handle's are, and what they ask for is done by step(). A goal that is cancelled, or replaced by
/// a newer one, is withdrawn from; the newer one is begun when the needle is out.
class InjectionAction {
 public:
  /// `controller` outlives this; `configured`: the goal that stands in its configuration.
  InjectionAction(const ros::NodeHandle& node, InjectionController& controller, const InjectionGoal& configured);

  /// After each step of the controller.
  void step(const ros::Time& now);

 private:
  void begin();
  void end();
  void tell(const ros::Time& now);

  InjectionController& controller_;
  InjectionGoal configured_;
  actionlib::SimpleActionServer<cell_microinjection::InjectAction> server_;
  bool serving_ = false;
  bool withdrawn_ = false;  ///< the preemption was passed on
  ros::Time told_;
};

}  // namespace microinjection
