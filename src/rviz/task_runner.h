#pragma once

#include <actionlib/action_definition.h>
#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "nodes/bus/bus.h"

namespace microinjection {

/// A client of one action that never waits. Its callbacks run as those of the bus.
class TaskRunner {
 public:
  using Progress = std::function<void(const std::string& text)>;
  using End = std::function<void(bool success, const std::string& message)>;

  virtual ~TaskRunner() = default;
  virtual bool there() const = 0;  ///< the action's node answers
  virtual void start() = 0;
  virtual void cancel() = 0;  ///< also a goal of somebody else
};

/// Whether a result is a success, and its message; empty: it has none. To be specialized for results with other fields.
template <typename Result>
std::pair<bool, std::string> outcomeOf(const Result& result) {
  return {result.success, result.message};
}

/// The end of a goal whose result says nothing, in actionlib's words.
std::string endText(const actionlib_msgs::GoalStatus& status);
/// Whether a goal with this status is over.
bool isOver(const actionlib_msgs::GoalStatus& status);

/// actionlib's SimpleActionClient on a bus. `describe`: the text of a feedback.
template <typename Action>
class ActionRunner : public TaskRunner {
 public:
  ACTION_DEFINITION(Action)

  ActionRunner(Bus& bus, const std::string& action, std::function<std::string(const Feedback&)> describe,
               Progress progress, End end)
      : bus_(bus),
        action_(action),
        describe_(std::move(describe)),
        progress_(std::move(progress)),
        end_(std::move(end)),
        goals_(bus.advertise<ActionGoal>(action + "/goal", kQueue)),
        cancels_(bus.advertise<actionlib_msgs::GoalID>(action + "/cancel", kQueue)) {
    status_ = bus.subscribe<actionlib_msgs::GoalStatusArray>(action + "/status", 1, [this](const auto& delivery) {
      server_ = delivery.raw.sender;
      onStatus(*delivery.message);
    });
    feedback_ = bus.subscribe<ActionFeedback>(action + "/feedback", kQueue, [this](const auto& delivery) {
      if (isMine(delivery.message->status)) progress_(describe_(delivery.message->feedback));
    });
    results_ = bus.subscribe<ActionResult>(action + "/result", kQueue, [this](const auto& delivery) {
      if (isMine(delivery.message->status)) onResult(*delivery.message);
    });
  }

  /// As actionlib has it: the node that publishes the status has connected all five topics.
  bool there() const override {
    return !server_.empty() && goals_.isSubscribedBy(server_) && cancels_.isSubscribedBy(server_) &&
           feedback_.publishers() > 0 && results_.publishers() > 0;
  }
  void start() override { start(Goal()); }
  void start(const Goal& goal) {
    const ros::Time now = bus_.now();
    ActionGoal message;
    message.header.stamp = message.goal_id.stamp = now;
    message.goal_id.id =
        bus_.name() + "-" + action_ + "-" + std::to_string(++sent_) + "-" + std::to_string(now.toNSec());
    message.goal = goal;
    id_ = message.goal_id.id;
    seen_ = Seen::kNot;
    goals_.publish(message);
  }
  /// Of a node that is gone nothing comes anymore.
  void forget() { id_.clear(); }
  /// An empty id is that of every goal.
  void cancel() override {
    if (there()) cancels_.publish(actionlib_msgs::GoalID());
  }

 private:
  static constexpr std::uint32_t kQueue = 10;
  enum class Seen { kNot, kUnderWay, kOver };  ///< the goal, in the server's status

  bool isMine(const actionlib_msgs::GoalStatus& status) const { return !id_.empty() && status.goal_id.id == id_; }

  void onResult(const ActionResult& message) {
    const auto [success, text] = outcomeOf(message.result);
    finish(success, text.empty() ? endText(message.status) : text);
  }
  /// A server that knows nothing of a goal that it had is another one.
  void onStatus(const actionlib_msgs::GoalStatusArray& message) {
    const auto& goals = message.status_list;
    const auto mine = std::find_if(goals.begin(), goals.end(), [this](const auto& goal) { return isMine(goal); });
    if (mine != goals.end()) {
      seen_ = isOver(*mine) ? Seen::kOver : Seen::kUnderWay;
    } else if (!id_.empty() && seen_ == Seen::kUnderWay) {
      actionlib_msgs::GoalStatus lost;
      lost.status = actionlib_msgs::GoalStatus::LOST;
      finish(false, endText(lost));
    }
  }
  void finish(bool success, const std::string& text) {
    id_.clear();
    end_(success, text);
  }

  Bus& bus_;
  std::string action_;
  std::function<std::string(const Feedback&)> describe_;
  Progress progress_;
  End end_;
  std::string server_;  ///< the node that publishes the status
  std::string id_;      ///< of the goal that is followed; empty: none
  unsigned sent_ = 0;
  Seen seen_ = Seen::kNot;
  Publisher<ActionGoal> goals_;
  Publisher<actionlib_msgs::GoalID> cancels_;
  Subscription status_, feedback_, results_;
};

}  // namespace microinjection
