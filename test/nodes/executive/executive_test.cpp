#include "nodes/executive/executive.h"

#include <gtest/gtest.h>
#include <std_msgs/Header.h>
#include <std_srvs/Trigger.h>

#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

/// A node that passes what it hears on, with its name added, once a step.
struct RelayNode {
  RelayNode(Bus& bus, const std::string& input, const std::string& output, Serving serving, double period,
            std::vector<std::string>& log)
      : publisher(bus.advertise<std_msgs::Header>(output, 10)) {
    subscription = bus.subscribe<std_msgs::Header>(
        input, 10, [this](const Delivery<std_msgs::Header>& delivery) { heard = delivery.message->frame_id; }, serving);
    bus.setStep(period, [&, this](const ros::Time&) {
      log.push_back(bus.name());
      std_msgs::Header message;
      message.frame_id = heard + bus.name();
      publisher.publish(message);
    });
    bus.onEnd([&] { log.push_back("end of " + bus.name()); });
  }

  std::string heard;
  Publisher<std_msgs::Header> publisher;
  Subscription subscription;
};

class ExecutiveTest : public testing::Test {
 protected:
  void addRelay(const std::string& name, const std::string& input, const std::string& output,
                Serving serving = Serving::kSampled, double period = 0.001) {
    executive_.add(name,
                   [=](Bus& bus) { return std::make_shared<RelayNode>(bus, input, output, serving, period, log_); });
  }
  void addThrower(const std::string& name, int steps) {
    executive_.add(name, [steps](Bus& bus) {
      bus.setStep(0.001, [left = steps](const ros::Time&) mutable {
        if (--left < 0) throw std::runtime_error("the cell is gone");
      });
      return std::make_shared<int>();
    });
  }
  long count(const std::string& entry) const { return std::count(log_.begin(), log_.end(), entry); }

  std::vector<std::string> log_;
  Executive executive_;
};

TEST_F(ExecutiveTest, NodesStepDownstreamWhateverTheOrderTheyWereAddedIn) {
  addRelay("force", "pose", "force", Serving::kDrives);
  addRelay("pose", "command", "pose", Serving::kDrives);
  addRelay("hand", "force", "command");  // feedback closes the loop
  executive_.runFor(0.0015);
  EXPECT_EQ(log_, (std::vector<std::string>{"/hand", "/pose", "/force", "/hand", "/pose", "/force"}));
}

TEST_F(ExecutiveTest, FeedbackArrivesOneStepLater) {
  addRelay("force", "pose", "force", Serving::kDrives);
  addRelay("pose", "force", "pose");
  std::vector<std::string> forces;
  executive_.add("probe", [&](Bus& bus) {
    return std::make_shared<Subscription>(bus.subscribe<std_msgs::Header>(
        "force", 10,
        [&](const Delivery<std_msgs::Header>& delivery) { forces.push_back(delivery.message->frame_id); }));
  });
  executive_.runFor(0.0015);
  EXPECT_EQ(forces, (std::vector<std::string>{"/pose/force", "/pose/force/pose/force"}));
}

TEST_F(ExecutiveTest, EachNodeHasItsOwnRate) {
  addRelay("slow", "none", "slow", Serving::kSampled, 1.0 / 30);
  addRelay("fast", "none", "fast", Serving::kSampled, 0.0005);
  executive_.runFor(0.9999);
  EXPECT_EQ(count("/slow"), 30);
  EXPECT_EQ(count("/fast"), 2000);
  EXPECT_DOUBLE_EQ(executive_.time(), 0.9999);
}

TEST_F(ExecutiveTest, DrivenNodeStepsByItselfWhenItsInputIsLate) {
  addRelay("pose", "command", "pose");
  addRelay("force", "pose", "force", Serving::kDrives);
  executive_.runFor(0.0105);
  EXPECT_EQ(count("/force"), 11);
  executive_.freeze("pose");
  executive_.runFor(0.01);
  EXPECT_EQ(count("/pose"), 11);
  EXPECT_EQ(count("/force"), 11 + 10);
}

TEST_F(ExecutiveTest, FrozenNodeAnswersNoService) {
  using std_srvs::Trigger;
  executive_.add("server", [](Bus& bus) {
    return std::make_shared<BusHandle>(
        bus.advertiseService<Trigger>("answer", [](Trigger::Request&, Trigger::Response&) { return true; }));
  });
  executive_.add("client", [](Bus&) { return std::make_shared<int>(0); });
  Trigger call;
  EXPECT_TRUE(executive_.bus("client").call("answer", call));
  executive_.freeze("server");
  EXPECT_FALSE(executive_.bus("client").call("answer", call));
  executive_.thaw("server");
  EXPECT_TRUE(executive_.bus("client").call("answer", call));
}

TEST_F(ExecutiveTest, CircleOfDrivingNodesIsRefused) {
  addRelay("pose", "force", "pose", Serving::kDrives);
  addRelay("force", "pose", "force", Serving::kDrives);
  try {
    executive_.runFor(0.001);
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("pose waits for force waits for pose"), std::string::npos) << error.what();
  }
}

TEST_F(ExecutiveTest, NodesWithoutStepsThatAnswerEachOtherWithoutEndAreRefused) {
  const auto echo = [&](const std::string& input, const std::string& output) {
    return [=](Bus& bus) {
      auto publisher = std::make_shared<Publisher<std_msgs::Header>>(bus.advertise<std_msgs::Header>(output, 10));
      auto subscription = std::make_shared<Subscription>(bus.subscribe<std_msgs::Header>(
          input, 10,
          [publisher](const Delivery<std_msgs::Header>& delivery) { publisher->publish(*delivery.message); }));
      return std::make_shared<std::pair<std::shared_ptr<void>, std::shared_ptr<void>>>(publisher, subscription);
    };
  };
  executive_.add("ping", echo("a", "b"));
  executive_.add("pong", echo("b", "a"));
  addRelay("start", "none", "a");
  EXPECT_THROW(executive_.runFor(0.001), ConfigError);
}

TEST_F(ExecutiveTest, NodeThatThrowsInAStepEndsAndTheOthersGoOn) {
  addThrower("thrower", 3);
  addRelay("other", "none", "other");
  executive_.runFor(0.0095);
  EXPECT_FALSE(executive_.runs("thrower"));
  EXPECT_EQ(executive_.failures().at("thrower"), "the cell is gone");
  EXPECT_EQ(count("/other"), 10);
}

TEST_F(ExecutiveTest, ANodeThatSomebodyElseHoldsCannotEndBeforeHim) {
  std::shared_ptr<void> held;
  executive_.add("held", [&](Bus&) { return held = std::make_shared<int>(); });
  EXPECT_THROW(executive_.end("held"), std::logic_error);
  held.reset();
  executive_.end("held");
}

TEST_F(ExecutiveTest, NodeThatThrowsInItsConstructorIsNamed) {
  const auto failing = [](Bus&) -> std::shared_ptr<void> { throw std::runtime_error("no cell"); };
  try {
    executive_.add("cell_simulator", failing);
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "node cell_simulator: no cell");
  }
  executive_.runFor(0.001);  // without it
}

TEST_F(ExecutiveTest, TwoNodesOfOneKindHaveNamesOfTheirOwn) {
  addRelay("one", "none", "one");
  addRelay("other", "none", "other");
  EXPECT_THROW(addRelay("one", "none", "third"), std::invalid_argument);
  executive_.runFor(0.0005);
  EXPECT_EQ(log_, (std::vector<std::string>{"/one", "/other"}));
}

TEST_F(ExecutiveTest, FrozenNodeFindsItsMessagesWhenItGoesOn) {
  addRelay("pose", "none", "pose");
  addRelay("force", "pose", "force");
  executive_.freeze("force");
  executive_.runFor(0.0105);
  EXPECT_EQ(count("/force"), 0);
  executive_.thaw("force");
  executive_.runFor(0.001);
  EXPECT_GE(count("/force"), 1);
}

TEST_F(ExecutiveTest, KilledNodeDoesNotEndInGoodOrderAndStartsAgain) {
  addRelay("node", "none", "out");
  executive_.runFor(0.0005);
  executive_.kill("node");
  EXPECT_EQ(count("end of /node"), 0);
  executive_.runFor(0.005);
  EXPECT_EQ(count("/node"), 1);
  executive_.restart("node");
  executive_.runFor(0.0005);
  EXPECT_EQ(count("/node"), 2);
  executive_.endAll();
  EXPECT_EQ(count("end of /node"), 1);
  EXPECT_FALSE(executive_.runs("node"));
}

TEST_F(ExecutiveTest, DelayedNodeStepsLateOnce) {
  addRelay("node", "none", "out");
  executive_.runFor(0.0005);
  executive_.delay("node", 0.02);
  executive_.runFor(0.01);
  EXPECT_EQ(count("/node"), 1);
  executive_.runFor(0.02);
  EXPECT_GT(count("/node"), 10);
  EXPECT_LT(count("/node"), 22);
}

TEST_F(ExecutiveTest, RunUntilStopsAtTheInstant) {
  addRelay("node", "none", "out");
  EXPECT_TRUE(executive_.runUntil([&] { return count("/node") == 5; }, 1));
  EXPECT_NEAR(executive_.time(), 0.004, 1e-12);
  EXPECT_FALSE(executive_.runUntil([] { return false; }, 0.5));
  EXPECT_NEAR(executive_.time(), 0.504, 1e-9);
}

}  // namespace
}  // namespace microinjection
