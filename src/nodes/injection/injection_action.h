#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <string>

#include "cell_microinjection/InjectAction.h"
#include "nodes/injection/inject_server.h"
#include "operation/control/injection_controller.h"

namespace microinjection {

/// The action /controller/inject (Inject.action) before an InjectionController. It has no thread: its messages are
/// heard where the node handle's are, and what they ask for is done by step(). A goal that is cancelled, or replaced by
/// a newer one, is withdrawn from; the newer one is begun when the needle is out. Of two that wait the newer one stays.
/// A goal that cannot be meant (InjectionGoal::problems(), a stamp ahead of the time) is refused when it comes, and the
/// one that runs goes on.
class InjectionAction {
 public:
  /// `controller` outlives this; `configured`: the goal that stands in its configuration.
  InjectionAction(const ros::NodeHandle& node, InjectionController& controller, const InjectionGoal& configured);

  /// After each step of the controller.
  void step(const ros::Time& now);

 private:
  using GoalHandle = InjectServer::GoalHandle;

  void receive(GoalHandle goal, const std::string& refusal);
  void cancel(GoalHandle goal);
  void refuse(GoalHandle goal, const std::string& refusal);
  void recall(const std::string& reason);
  void begin();
  void end();
  void publishFeedback();

  InjectionController& controller_;
  InjectionGoal configured_;
  GoalHandle current_, next_;  ///< not valid: none
  bool leaves_ = false;        ///< the current goal is to end
  bool withdrawn_ = false;     ///< the controller knows that
  std::int64_t fed_back_ns_ = 0;
  InjectServer server_;
};

}  // namespace microinjection
