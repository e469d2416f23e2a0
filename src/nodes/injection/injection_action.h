#pragma once

#include <string>

#include "cell_microinjection/InjectAction.h"
#include "nodes/bus/action_server.h"
#include "operation/control/injection_controller.h"

namespace microinjection {

/// The action /controller/inject (Inject.action) of an InjectionController. It has no thread: its
/// messages are received with the bus's, and step() executes them.
/// - A goal that is cancelled or replaced by a newer one ends with a withdrawal; the newer one
///   begins when the needle is out. Of two waiting goals the newer one stays.
/// - An implausible goal (InjectionGoal::problems(), a stamp ahead of the time) is refused on
///   arrival, and the running one continues.
class InjectionAction {
 public:
  /// `controller` outlives this; `configured`: the goal of its configuration.
  InjectionAction(Bus& bus, InjectionController& controller, const InjectionGoal& configured);

  /// Call after each step of the controller.
  void step(const ros::Time& now);

 private:
  using GoalHandle = ActionServer<cell_microinjection::InjectAction>::GoalHandle;

  void receive(GoalHandle goal, const std::string& refusal);
  void cancel(GoalHandle goal);
  void refuse(GoalHandle goal, const std::string& refusal);
  void recall(const std::string& reason);
  void begin();
  void end();
  void publishFeedback();

  InjectionController& controller_;
  InjectionGoal configured_;
  GoalHandle current_, next_;   ///< not valid: none
  bool end_requested_ = false;  ///< the current goal shall end
  bool withdrawn_ = false;      ///< the controller has the command
  ros::Time fed_back_;
  ActionServer<cell_microinjection::InjectAction> server_;
};

}  // namespace microinjection
