#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cell_microinjection/CellEstimate.h"
#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

using actionlib_msgs::GoalStatus;
using cell_microinjection::InjectGoal;
using cell_microinjection::InjectResult;

/// The action Inject: what cannot be meant is refused and costs no later goal; from wherever it is cancelled the needle
/// comes out.
class InjectActionTest : public testing::Test {
 protected:
  using Client = ActionClient<cell_microinjection::InjectAction>;

  InjectResult result(const Client& client) {
    EXPECT_TRUE(chain_.session.until([&] { return client.ended(); }, 30)) << chain_.status();
    return client.ended() ? *client.result() : InjectResult();
  }
  InjectResult result() { return result(client_); }
  void expectRefused(const Client& client, const std::string& why) {
    const InjectResult refused = result(client);
    EXPECT_EQ(client.state(), GoalStatus::ABORTED);
    EXPECT_EQ(refused.outcome, "refused");
    EXPECT_NE(refused.reason.find(why), std::string::npos) << refused.reason << " has no " << why;
  }
  void expectPreempted() {
    EXPECT_EQ(result().outcome, "preempted");
    EXPECT_EQ(client_.state(), GoalStatus::PREEMPTED);
    chain_.expectOut(start_);
  }
  void expectServed() {
    client_.send(indentationGoal());
    EXPECT_EQ(result().outcome, "indented");
    EXPECT_EQ(client_.state(), GoalStatus::SUCCEEDED);
    chain_.expectOut(start_);
  }
  bool indents(double depth) { return chain_.status().state == "indent" && chain_.status().depth > depth; }
  bool serverKnows(const std::string& id) const {
    const auto* status = client_.status().newest();
    return status && std::any_of(status->status_list.begin(), status->status_list.end(),
                                 [&](const auto& goal) { return goal.goal_id.id == id; });
  }

  InjectionChain chain_;
  Client client_{chain_.session.world(), "controller/inject"};
  Client others_{chain_.session.world(), "controller/inject"};
  const Eigen::Vector3d start_ = chain_.resting();
};

TEST_F(InjectActionTest, AGoalThatCannotBeIsAbortedWithTheReason) {
  const auto expectRefusal = [&](const std::function<void(InjectGoal&)>& change, const std::string& why) {
    InjectGoal goal = punctureGoal();
    change(goal);
    client_.send(goal);
    expectRefused(client_, why);
  };
  expectRefusal([](auto& goal) { goal.layers = 0; }, "layers = 0");
  expectRefusal([](auto& goal) { goal.depth = 200e-6; }, "allowed up to depth_limit = ");
  expectRefusal([](auto& goal) { goal.depth = NAN; }, "depth = nan");
  expectRefusal([](auto& goal) { goal.depth = 1; }, "depth = 1 m, allowed (0, 0.001] m");
  expectRefusal([](auto& goal) { goal.margin = 1e9; }, "margin = 1e+09 m, allowed [0, 0.001] m");
  expectRefusal([](auto& goal) { goal.hold_time = 1e300; }, "hold_time = 1e+300 s, allowed [0, 600] s");
  expectRefusal([](auto& goal) { goal.pressure = 1e300; }, "pulse/pressure = 1e+300 Pa, allowed [0, 1e+06] Pa");
  expectRefusal([](auto& goal) { goal.pressure = -1; }, "pulse/pressure = -1 Pa");
  expectRefusal([](auto& goal) { goal.duration = 61; }, "pulse/duration = 61 s");
  expectRefusal([](auto& goal) { goal.volume = INFINITY; }, "pulse/volume = inf m^3");
  EXPECT_EQ(chain_.needle(), start_);
}

TEST_F(InjectActionTest, AGoalWhoseStampIsAheadCostsNoOther) {
  others_.send(indentationGoal(), ros::TIME_MAX, "last");
  expectRefused(others_, "s ahead of the time, allowed 1 s");
  others_.send(indentationGoal(), chain_.session.now() + ros::Duration(3600), "later");
  expectRefused(others_, "s ahead of the time, allowed 1 s");
  expectServed();
  client_.send(indentationGoal());
  ASSERT_TRUE(chain_.reaches("approach"));
  others_.send(indentationGoal(), ros::TIME_MAX, "beside");
  expectRefused(others_, "s ahead of the time, allowed 1 s");
  EXPECT_EQ(chain_.status().state, "approach");
  EXPECT_EQ(result().outcome, "indented");
  chain_.expectOut(start_);
}

TEST_F(InjectActionTest, ACancelWhoseStampIsAheadEndsThePresentGoalAlone) {
  client_.send(indentationGoal());
  ASSERT_TRUE(chain_.reaches("approach"));
  client_.cancel("", ros::TIME_MAX);  // of all that are known
  expectPreempted();
  expectServed();
  // That of a goal that nobody knows is remembered for 5 s.
  client_.cancel("nobody", ros::TIME_MAX);
  client_.cancel("nobody else", ros::Time());
  chain_.session.run(0.3);
  EXPECT_TRUE(serverKnows("nobody"));
  EXPECT_TRUE(serverKnows("nobody else"));
  chain_.session.run(5.3);
  EXPECT_FALSE(serverKnows("nobody"));
  EXPECT_FALSE(serverKnows("nobody else"));
  expectServed();
}

TEST_F(InjectActionTest, ANewerGoalReplacesTheOneThatRunsOnceTheNeedleIsOut) {
  client_.send(punctureGoal());
  ASSERT_TRUE(chain_.reaches("indent"));
  client_.send(indentationGoal());
  chain_.session.run(2e-3);
  EXPECT_EQ(chain_.status().state, "withdraw");
  EXPECT_EQ(client_.results().count(), 0u);
  EXPECT_TRUE(chain_.session.until([&] { return client_.results().count() > 0; }, 5));
  EXPECT_LT((chain_.needle() - start_).norm(), 1e-6);
  EXPECT_EQ(result().outcome, "indented");
  EXPECT_EQ(client_.state(), GoalStatus::SUCCEEDED);
  ASSERT_EQ(client_.results().count(), 2u);
  EXPECT_EQ(client_.results().all()[0]->result.outcome, "preempted");
  chain_.expectOut(start_);
}

TEST_F(InjectActionTest, CancelledWhileItIndentsItWithdraws) {
  client_.send(punctureGoal());
  ASSERT_TRUE(chain_.session.until([&] { return indents(1e-6); })) << chain_.status();
  EXPECT_GT(chain_.cell().force.z, 0);
  client_.cancel();
  chain_.session.run(2e-3);
  EXPECT_EQ(chain_.status().state, "withdraw");
  const double at = chain_.needle().z();
  double lowest = at;
  for (int i = 0; i < 200; ++i) {
    chain_.session.run(1e-3);
    lowest = std::min(lowest, chain_.needle().z());
  }
  EXPECT_GT(lowest, at - 0.5e-6);
  EXPECT_EQ(chain_.status().state, "withdraw");
  EXPECT_EQ(result().punctures, 0);
  expectPreempted();
  EXPECT_FALSE(chain_.cell().punctured);
}

/// The estimator expects a puncture beyond the limit of the force.
class ExpectedPunctureTest : public InjectActionTest {
 protected:
  void expectPuncture(const std::string& verdict, double age) {
    const double limit = chain_.session.parameters("injection_controller")["force_limit"].as<double>();
    estimate_.verdict = verdict;
    estimate_.puncture.force_low = 1.1 * limit;
    estimate_.puncture.force = 1.2 * limit;
    estimate_.puncture.force_high = 1.3 * limit;
    estimate_.puncture.depth_low = 1e-6;
    estimate_.puncture.depth = 2e-6;
    estimate_.puncture.depth_high = 3e-6;
    age_ = age;
  }
  bool until(const std::function<bool()>& done) {
    return chain_.session.until(
        [&] {
          estimate_.header.stamp = chain_.session.now() - ros::Duration(age_);
          chain_.session.world().say("cell/estimate", estimate_);
          return done();
        },
        30);
  }

  cell_microinjection::CellEstimate estimate_;
  double age_ = 0;  // s
};

TEST_F(ExpectedPunctureTest, OfAnEstimatorThatIsContradictedOrDeadCountsForNothing) {
  for (const auto& [verdict, age] : {std::pair("inconsistent", 0), {"converged", 1}, {"converged", -1}}) {
    SCOPED_TRACE(verdict + std::string(" ") + std::to_string(age));
    expectPuncture(verdict, age);
    client_.send(punctureGoal());
    EXPECT_TRUE(until([&] { return indents(1e-6); })) << chain_.status();
    client_.cancel();
    expectPreempted();
  }
}

TEST_F(ExpectedPunctureTest, BeyondTheLimitsIsNotTried) {
  expectPuncture("learning", 0);
  client_.send(punctureGoal());
  ASSERT_TRUE(until([&] { return client_.ended(); })) << chain_.status();
  EXPECT_EQ(client_.result()->outcome, "guard");
  EXPECT_EQ(client_.result()->punctures, 0);
  EXPECT_NE(client_.result()->reason.find("the puncture is expected above"), std::string::npos);
  EXPECT_LT(client_.result()->max_depth, 1e-6);
  chain_.say("withdraw");
  ASSERT_TRUE(chain_.reaches("withdraw"));
  ASSERT_TRUE(chain_.reaches("idle"));
  chain_.expectOut(start_);
  EXPECT_FALSE(chain_.cell().punctured);
}

/// The device hears the end of a pulse after 0.4 s at the earliest.
TEST(RefusedPulseTest, EndsTheInjectionWithTheInjectorsReason) {
  InjectionChain chain({"injector:=emulated_arduino"});
  ActionClient<cell_microinjection::InjectAction> client(chain.session.world(), "controller/inject");
  const Eigen::Vector3d start = chain.resting();
  InjectGoal goal = punctureGoal();
  goal.duration = 0.3;
  client.send(goal);
  ASSERT_TRUE(chain.session.until([&] { return client.ended(); }, 30)) << chain.status();
  EXPECT_EQ(client.state(), GoalStatus::ABORTED);
  EXPECT_EQ(client.result()->outcome, "not_injected");
  EXPECT_EQ(client.result()->reason, "the injector refused the pulse: pulse duration = 0.3 s, allowed [0.4, 60] s");
  EXPECT_EQ(chain.injector().pulses, 0U);
  chain.expectOut(start);
}

}  // namespace
}  // namespace microinjection
