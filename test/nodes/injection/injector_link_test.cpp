#include "nodes/injection/injector_link.h"

#include <gtest/gtest.h>

#include "nodes/bus/local_bus.h"
#include "nodes/bus/local_network.h"
#include "test_node.h"

namespace microinjection {
namespace {

using cell_microinjection::InjectionPulse;
using cell_microinjection::InjectorState;

class InjectorLinkTest : public testing::Test {
 protected:
  /// What the injector tells, and what the controller then knows.
  std::optional<InjectorReport> told(const std::string& refusal, const std::string& fault = "") {
    network_.setTime(network_.now() + ros::Duration(0.01));
    InjectorState state;
    state.header.stamp = network_.now();
    state.refusal = refusal;
    state.fault = fault;
    state_.publish(state);
    controller_->run();
    return link_.report(network_.now());
  }
  std::uint64_t request() {
    link_.setPulse(PulseGoal(), network_.now());
    injector_->run();
    return pulses_.count() > 0 ? pulses_.newest()->id : 0;
  }
  static std::string refused(std::uint64_t id) { return "pulse " + std::to_string(id) + " refused: too short"; }

  LocalNetwork network_{ros::Time(10)};
  std::unique_ptr<LocalBus> controller_ = network_.connect("/controller", YAML::Node(YAML::NodeType::Map));
  std::unique_ptr<LocalBus> injector_ = network_.connect("/injector", YAML::Node(YAML::NodeType::Map));
  Probe<InjectionPulse> pulses_{*injector_, "injector/pulse"};
  Publisher<InjectorState> state_ = injector_->advertise<InjectorState>("injector/state", 10);
  Cycle cycle_{*controller_, 1000};
  InjectorLink link_{cycle_, 1};
};

TEST_F(InjectorLinkTest, ARefusalIsOfItsPulseAndOfNoLaterOne) {
  ASSERT_TRUE(told(""));
  const std::uint64_t first = request();
  ASSERT_NE(first, 0U);
  EXPECT_EQ(told(refused(first))->refusal, "too short");
  link_.setPulse(std::nullopt, network_.now());
  EXPECT_EQ(told(refused(first))->refusal, "") << "it is over";
  const std::uint64_t second = request();
  EXPECT_NE(second, first);
  EXPECT_EQ(told(refused(first))->refusal, "") << "that was the one before";
  EXPECT_TRUE(told(refused(first))->busy);
  EXPECT_EQ(told(refused(second))->refusal, "too short");
}

TEST_F(InjectorLinkTest, ARefusalByAFaultIsTold) {
  ASSERT_TRUE(told(""));
  const std::uint64_t id = request();
  const auto report = told(refused(id), "no reply to a query");
  ASSERT_TRUE(report);
  EXPECT_EQ(report->refusal, "too short");
  EXPECT_FALSE(told("", "no reply to a query")->busy);
  link_.setPulse(std::nullopt, network_.now());
  EXPECT_FALSE(told("", "no reply to a query"));
}

/// The next one may be in time, and is taken.
TEST_F(InjectorLinkTest, AMessageThatCameLateIsNoRefusal) {
  ASSERT_TRUE(told(""));
  const std::uint64_t id = request();
  const auto report = told("a message of pulse " + std::to_string(id) + " refused: it is stale");
  EXPECT_EQ(report->refusal, "");
  EXPECT_TRUE(report->busy);
}

}  // namespace
}  // namespace microinjection
