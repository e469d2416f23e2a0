#pragma once

#include <exception>
#include <string>

#include "nodes/bus/action_server.h"
#include "nodes/bus/diagnostics.h"

namespace microinjection {

/// A node for an action that pursues one goal at a time, as actionlib's SimpleActionServer: a newer goal
/// ends the present one as preempted, and so does a cancel; a goal with an older stamp than the last one
/// is cancelled. A goal that is refused (see ActionServer) leaves the present one alone.
template <typename Action>
class GoalNode {
 public:
  GoalNode(const GoalNode&) = delete;
  GoalNode& operator=(const GoalNode&) = delete;
  virtual ~GoalNode() = default;

 protected:
  ACTION_DEFINITION(Action)

  /// `task`: of the diagnostics, see report(). `period`: s of steady time, of step().
  GoalNode(Bus& bus, const std::string& action, const std::string& task, double period)
      : bus_(bus),
        diagnostics_(bus),
        server_(
            bus, action, [this](GoalHandle goal, const std::string& refusal) { receive(goal, refusal); },
            [this](GoalHandle goal) { cancel(goal); }),
        timer_(bus.timer(period, [this] {
          diagnostics_.update();
          server_.step(bus_.now());
          step();
        })) {
    diagnostics_.add(task, [this](diagnostic_updater::DiagnosticStatusWrapper& status) { report(status); });
  }

  /// Throws with the reason when the goal must not begin.
  virtual void begin(const Goal& goal) = 0;
  /// Ends what the goal has begun, or tried to. @returns its result, without success and message
  virtual Result end(bool success) = 0;
  /// Called each period, with and without a goal.
  virtual void step() = 0;
  virtual void report(diagnostic_updater::DiagnosticStatusWrapper& status) = 0;

  /// Ends the goal.
  // By value: end() may destroy what has the text.
  void finish(bool success, std::string message) {  // NOLINT(performance-unnecessary-value-param)
    outcome_ = message;
    Result result = end(success);
    result.success = static_cast<unsigned char>(success);
    result.message = message;
    active_ = false;
    if (success) {
      current_.setSucceeded(result, message);
    } else if (preempted_) {
      current_.setCanceled(result, message);
    } else {
      current_.setAborted(result, message);
    }
  }
  void publishFeedback(const Feedback& feedback) { current_.publishFeedback(feedback); }

  bool isActive() const { return active_; }
  bool isPreempted() const { return preempted_; }          ///< the last goal was, by a newer one or a cancel
  const std::string& outcome() const { return outcome_; }  ///< of the last goal, in words

  Bus& bus_;

 private:
  using GoalHandle = typename ActionServer<Action>::GoalHandle;

  void receive(GoalHandle goal, const std::string& refusal) {
    if (!refusal.empty()) {
      Result result;
      result.message = refusal;
      goal.setAccepted();
      return goal.setAborted(result, refusal);
    }
    // A last goal from the future tells nothing: the clock was set back.
    const bool comparable = current_.isValid() && current_.getGoalID().stamp <= bus_.now();
    if (comparable && goal.getGoalID().stamp < current_.getGoalID().stamp)
      return goal.setCanceled(Result(), "a newer goal has come before");
    if (active_) preempt();
    current_ = goal;
    active_ = true;
    preempted_ = false;
    current_.setAccepted();
    try {
      begin(*current_.getGoal());
    } catch (const std::exception& error) {
      finish(false, error.what());
    }
  }
  void cancel(GoalHandle goal) {
    if (active_ && goal == current_) preempt();
  }
  void preempt() {
    preempted_ = true;
    finish(false, "cancelled");
  }

  std::string outcome_ = "no goal yet";
  GoalHandle current_;  ///< the last one; not valid: none yet
  bool active_ = false, preempted_ = false;
  Diagnostics diagnostics_;
  ActionServer<Action> server_;
  BusHandle timer_;
};

}  // namespace microinjection
