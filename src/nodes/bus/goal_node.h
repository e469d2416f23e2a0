#pragma once

#include <exception>
#include <string>

#include "nodes/bus/action_server.h"
#include "nodes/bus/diagnostics.h"

namespace microinjection {

/// A node for an action that pursues one goal at a time, such as finding the focus or the touch. It has the rules of
/// actionlib's SimpleActionServer, which clients know, but not its code, which takes a node handle of roscpp and, to
/// execute a goal, a thread; neither is there in virtual time. Here the derived class is asked in each period what to
/// do next, as a Cycle asks in each step, so that it needs no lock and never waits. The period is that of a timer and
/// not of messages, because a goal must also end when what it waits for falls silent.
///
///     a goal arrives                       the present goal    the new one
///     more than 1 s ahead of the time      goes on             ABORTED, with the reason
///     with an older stamp than the last    goes on             RECALLED, also when the last one has ended
///     any other                            PREEMPTED           begin(); ABORTED if that throws
///
///     an active goal ends
///     by finish(true, ...)                 SUCCEEDED
///     by finish(false, ...)                ABORTED
///     by a cancel, or by a newer goal      PREEMPTED
///
/// A stamp far in the future must not win: a client whose clock is wrong would keep all others out. For the same
/// reason the last goal is no measure for the next one once the clock of this host was set back behind its stamp.
/// Each end of a goal, also that of one whose begin() has thrown, passes end(), so that whatever moves is stopped in
/// one place.
///
/// A derived class implements the four virtual functions. Its constructor must not wait on the bus (Bus::waitUntil),
/// which would call them before the object is complete.
///
/// @tparam Action  of actionlib, with `success` (bool) and `message` (string) in its result
template <typename Action>
class GoalNode {
 public:
  GoalNode(const GoalNode&) = delete;
  GoalNode& operator=(const GoalNode&) = delete;
  virtual ~GoalNode() = default;

 protected:
  ACTION_DEFINITION(Action)

  /// `action`: its name, below which its topics are; `task`: name of report() in the diagnostics; `period`: of step()
  /// (s of steady time). `bus` outlives the node.
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

  /// Begins what the goal asks for, and returns at once. Throws std::exception with the reason when it must not
  /// begin.
  virtual void begin(const Goal& goal) = 0;
  /// Ends what the goal has begun, or tried to: nothing must move on its behalf afterwards. `success`: as in
  /// finish().
  /// @returns its result; finish() fills in success and message
  virtual Result end(bool success) = 0;
  /// Called each period, with and without a goal; calls finish() when the goal is reached or out of reach.
  virtual void step() = 0;
  /// Fills in the status of the diagnostics: level, message and values.
  virtual void report(diagnostic_updater::DiagnosticStatusWrapper& status) = 0;

  /// Ends the active goal: calls end(), then tells the clients. `message`: for people, in the result and outcome().
  /// @pre isActive(), or within begin()
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
  /// @pre a goal was accepted
  void publishFeedback(const Feedback& feedback) { current_.publishFeedback(feedback); }

  bool isActive() const { return active_; }                ///< from before begin() to the end of finish()
  bool isPreempted() const { return preempted_; }          ///< the last goal was, by a newer one or a cancel
  const std::string& outcome() const { return outcome_; }  ///< of the last goal, in words

  Bus& bus_;  ///< of the node

 private:
  using GoalHandle = typename ActionServer<Action>::GoalHandle;

  /// A goal of a client. `refusal`: why its stamp lets it not begin; empty: it may. Such a goal ends as one whose
  /// begin() has thrown, but without begin() and end().
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
  /// A client wants this goal to end, which may have ended meanwhile.
  void cancel(GoalHandle goal) {
    if (active_ && goal == current_) preempt();
  }
  /// Ends the active goal for a reason that is not its own: its clients see PREEMPTED instead of ABORTED.
  void preempt() {
    preempted_ = true;
    finish(false, "cancelled");
  }

  std::string outcome_ = "no goal yet";
  GoalHandle current_;  ///< the last one; not valid: none yet
  bool active_ = false, preempted_ = false;
  Diagnostics diagnostics_;
  ActionServer<Action> server_;  ///< calls receive() and cancel()
  BusHandle timer_;              ///< last member: ends before what its task uses
};

}  // namespace microinjection
