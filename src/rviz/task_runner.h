#pragma once

#include <actionlib/client/simple_action_client.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace microinjection {

/// A client of one action that lives in the caller's callback queue and never waits.
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

/// `describe`: the text of a feedback.
template <typename Action, typename Goal, typename Feedback, typename Result>
class ActionRunner : public TaskRunner {
 public:
  ActionRunner(ros::NodeHandle& node, const std::string& name, std::function<std::string(const Feedback&)> describe,
               Progress progress, End end)
      : client_(node, name, false),
        describe_(std::move(describe)),
        progress_(std::move(progress)),
        end_(std::move(end)) {}

  bool there() const override { return client_.isServerConnected(); }
  void start() override { start(Goal()); }
  void start(const Goal& goal) {
    client_.sendGoal(
        goal,
        [this](const actionlib::SimpleClientGoalState& state, const boost::shared_ptr<const Result>& result) {
          const auto [success, text] = result ? outcomeOf(*result) : std::pair(false, std::string());
          end_(success, text.empty() ? state.toString() + " " + state.getText() : text);
        },
        {}, [this](const boost::shared_ptr<const Feedback>& feedback) { progress_(describe_(*feedback)); });
  }
  /// Of a node that is gone nothing comes anymore.
  void forget() { client_.stopTrackingGoal(); }
  void cancel() override {
    if (client_.isServerConnected()) client_.cancelAllGoals();
  }

 private:
  actionlib::SimpleActionClient<Action> client_;
  std::function<std::string(const Feedback&)> describe_;
  Progress progress_;
  End end_;
};

}  // namespace microinjection
