#include "nodes/bus/goal_node.h"

#include <cell_microinjection/GoToPixelAction.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "nodes/bus/local_bus.h"
#include "nodes/bus/local_network.h"

namespace microinjection {
namespace {

using actionlib_msgs::GoalStatus;
using Action = cell_microinjection::GoToPixelAction;
using Server = actionlib::ActionServerBase<Action>;

/// Succeeds after x steps; x below 0 is refused.
class Countdown : public GoalNode<Action> {
 public:
  explicit Countdown(Bus& bus) : GoalNode(bus, "count", "count", 0.1) {}
  int ended = 0;

 private:
  void begin(const Goal& goal) override {
    if (goal.x < 0) throw ConfigError("x is below 0");
    left_ = static_cast<int>(goal.x);
  }
  Result end(bool) override {
    ++ended;
    return {};
  }
  void step() override {
    if (!isActive()) return;
    publishFeedback(Feedback());
    if (--left_ == 0) finish(true, "counted");
  }
  void report(diagnostic_updater::DiagnosticStatusWrapper&) override {}

  int left_ = 0;
};

class GoalNodeTest : public testing::Test {
 protected:
  GoalNodeTest() {
    results_ = client_->subscribe<Server::ActionResult>("count/result", 50, [this](const auto& delivery) {
      ended_.push_back({delivery.message->status.goal_id.id, delivery.message->status.status});
      last_ = *delivery.message;
    });
    statuses_ = client_->subscribe<actionlib_msgs::GoalStatusArray>("count/status", 50, [this](const auto& delivery) {
      stamps_.push_back(delivery.message->header.stamp.toSec());
      goals_ = delivery.message->status_list.size();
    });
  }
  void send(const std::string& id, double x, double lead = 0) {
    Server::ActionGoal goal;
    goal.goal_id.id = id;
    goal.goal_id.stamp = network_.now() + ros::Duration(lead);
    goal.goal.x = x;
    goals_out_.publish(goal);
    run(0.01);
  }
  void cancel(const std::string& id) {
    actionlib_msgs::GoalID goal;
    goal.id = id;
    cancels_.publish(goal);
    run(0.01);
  }
  void run(double seconds) {
    for (int i = 0; i < seconds * 100; ++i) {
      network_.setTime(network_.now() + ros::Duration(0.01));
      node_bus_->run();
      client_->run();
    }
  }
  using Ends = std::vector<std::pair<std::string, int>>;

  struct Clock {
    Clock() { ros::Time::init(); }
  } clock_;
  LocalNetwork network_{ros::Time(10)};
  std::unique_ptr<LocalBus> node_bus_ = network_.connect("/node", YAML::Node(YAML::NodeType::Map)),
                            client_ = network_.connect("/client", YAML::Node(YAML::NodeType::Map));
  Countdown node_{*node_bus_};
  Publisher<Server::ActionGoal> goals_out_ = client_->advertise<Server::ActionGoal>("count/goal", 10);
  Publisher<actionlib_msgs::GoalID> cancels_ = client_->advertise<actionlib_msgs::GoalID>("count/cancel", 10);
  Subscription results_, statuses_;
  Ends ended_;
  Server::ActionResult last_;
  std::vector<double> stamps_;
  std::size_t goals_ = 0;
};

TEST_F(GoalNodeTest, AGoalSucceeds) {
  send("a", 3);
  run(1);
  EXPECT_EQ(ended_, (Ends{{"a", GoalStatus::SUCCEEDED}}));
  EXPECT_TRUE(last_.result.success);
  EXPECT_EQ(last_.result.message, "counted");
}
TEST_F(GoalNodeTest, ANewerGoalPreempts) {
  send("a", 30);
  run(1);
  send("b", 3);
  run(1);
  EXPECT_EQ(ended_, (Ends{{"a", GoalStatus::PREEMPTED}, {"b", GoalStatus::SUCCEEDED}}));
}
TEST_F(GoalNodeTest, AnOlderGoalIsRecalled) {
  send("a", 30);
  run(1);
  send("b", 3, -0.9 - 0.2);
  run(3);
  EXPECT_EQ(ended_, (Ends{{"b", GoalStatus::RECALLED}, {"a", GoalStatus::SUCCEEDED}}));
}
TEST_F(GoalNodeTest, ACancelPreempts) {
  send("a", 30);
  cancel("a");
  EXPECT_EQ(ended_, (Ends{{"a", GoalStatus::PREEMPTED}}));
  EXPECT_EQ(last_.result.message, "cancelled");
  cancel("");
  send("b", 3);
  run(1);
  EXPECT_EQ(ended_.back(), (Ends::value_type{"b", GoalStatus::SUCCEEDED}));
  EXPECT_EQ(node_.ended, 2);
}
TEST_F(GoalNodeTest, ARefusedGoalAborts) {
  send("a", -1);
  EXPECT_EQ(ended_, (Ends{{"a", GoalStatus::ABORTED}}));
  EXPECT_EQ(last_.result.message, "x is below 0");
}
TEST_F(GoalNodeTest, AGoalAheadOfTimeLeavesThePresentOneAlone) {
  send("a", 30);
  send("b", 3, 5);
  EXPECT_EQ(ended_, (Ends{{"b", GoalStatus::ABORTED}}));
  run(4);
  EXPECT_EQ(ended_.back(), (Ends::value_type{"a", GoalStatus::SUCCEEDED}));
  send("c", 3);
  run(1);
  EXPECT_EQ(ended_.back(), (Ends::value_type{"c", GoalStatus::SUCCEEDED}));
}
TEST_F(GoalNodeTest, StatusFiveTimesASecondAndFor5s) {
  run(2.05);
  EXPECT_EQ(stamps_.size(), 11u);
  send("a", 1);
  send("b", 1);
  run(4.5);
  EXPECT_EQ(goals_, 2u);
  run(1);
  EXPECT_EQ(goals_, 1u);  // the last one stays, as with SimpleActionServer
}

TEST_F(GoalNodeTest, AGoalOlderThanTheLastOneIsCancelledAlsoWhenThatHasEnded) {
  send("first", 1);
  run(0.5);
  send("older", 1, -0.7);
  run(0.5);
  EXPECT_EQ(ended_, (Ends{{"first", GoalStatus::SUCCEEDED}, {"older", GoalStatus::RECALLED}}));
  EXPECT_EQ(node_.ended, 1);
}

TEST_F(GoalNodeTest, AClockThatWasSetBackRefusesNoGoal) {
  send("before", 1);
  run(0.5);
  network_.setTime(network_.now() - ros::Duration(5));
  send("after", 1);
  run(6);
  EXPECT_EQ(ended_, (Ends{{"before", GoalStatus::SUCCEEDED}, {"after", GoalStatus::SUCCEEDED}}));
}

}  // namespace
}  // namespace microinjection
