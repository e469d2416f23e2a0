#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Two nodes that share a session: what the contract needs of a kind of bus. `serve` has both handle what
/// arrives until `done`, or until that kind of bus gives up.
class BusPair {
 public:
  virtual ~BusPair() = default;
  virtual Bus& first() = 0;
  virtual Bus& second() = 0;
  virtual bool serve(const std::function<bool()>& done) = 0;
  using Step = std::function<void(const ros::Time&)>;
  /// Has the second node step until `done`, which is asked after each step; see Bus::setStep.
  virtual bool runSecond(double period, const Step& step, const std::function<bool()>& done) = 0;
  /// Sets the second node's own parameters, and one of the session.
  static constexpr const char* kParameters = "{rate: 100, name: probe, list: [1, 2], map: {deep: 2.5}, flag: true}";
};

/// What a node may rely on with any bus. Pair: a BusPair with a default constructor.
template <typename Pair>
class BusContract : public testing::Test {
 protected:
  using Wrench = geometry_msgs::WrenchStamped;

  static Wrench wrench(double force) {
    Wrench message;
    message.header.stamp = ros::Time(12);
    message.wrench.force.z = force;
    return message;
  }

  /// Keeps what a subscription receives.
  struct Record {
    std::vector<Delivery<Wrench>> deliveries;
    std::vector<RawDelivery> raw;
    std::vector<double> forces;
    Subscription subscription;
  };
  std::unique_ptr<Record> record(Bus& bus, const std::string& topic, unsigned queue = 100,
                                 Serving serving = Serving::kSampled) {
    auto record = std::make_unique<Record>();
    record->subscription = bus.subscribe<Wrench>(
        topic, queue,
        [kept = record.get()](const Delivery<Wrench>& delivery) {
          kept->raw.push_back(delivery.raw);
          kept->forces.push_back(delivery.message->wrench.force.z);
        },
        serving);
    return record;
  }
  /// Waits until publisher and subscription are connected.
  bool connects(const Publisher<Wrench>& publisher, std::size_t subscribers = 1) {
    return pair_.serve([&] { return publisher.subscribers() >= subscribers; });
  }

  Pair pair_;
};

TYPED_TEST_SUITE_P(BusContract);

TYPED_TEST_P(BusContract, MessageArrivesWithSenderTimeAndNumber) {
  Bus &first = this->pair_.first(), &second = this->pair_.second();
  const auto received = this->record(second, "force");
  const auto publisher = first.advertise<geometry_msgs::WrenchStamped>("force", 10);
  ASSERT_TRUE(this->connects(publisher));
  EXPECT_TRUE(publisher.isSubscribedBy(second.name()));
  EXPECT_FALSE(publisher.isSubscribedBy("/nobody"));
  EXPECT_EQ(publisher.topic(), "/force");
  publisher.publish(this->wrench(1));
  publisher.publish(this->wrench(2));
  ASSERT_TRUE(this->pair_.serve([&] { return received->forces.size() == 2; }));
  EXPECT_EQ(received->forces, (std::vector<double>{1, 2}));
  EXPECT_EQ(received->raw[0].sender, first.name());
  EXPECT_FALSE(received->raw[0].latched);
  EXPECT_FALSE(received->raw[0].received.isZero());
  EXPECT_EQ(received->raw[0].connection, received->raw[1].connection);
  const auto at = [&](int i) {
    return boost::static_pointer_cast<const geometry_msgs::WrenchStamped>(received->raw[i].message)->header;
  };
  EXPECT_EQ(at(0).stamp, ros::Time(12));
  EXPECT_EQ(at(1).seq, at(0).seq + 1);
}

TYPED_TEST_P(BusContract, ImageArrivesWithItsSender) {
  Bus &first = this->pair_.first(), &second = this->pair_.second();
  std::vector<std::string> senders;
  const Subscription images =
      second.subscribeImages("image", 1, [&](const RawDelivery& delivery) { senders.push_back(delivery.sender); });
  const auto publisher = first.advertiseImages("image", 1);
  ASSERT_TRUE(this->pair_.serve([&] { return publisher->subscribers() == 1; }));
  const sensor_msgs::Image image;
  publisher->publish(&image);
  ASSERT_TRUE(this->pair_.serve([&] { return !senders.empty(); }));
  EXPECT_EQ(senders[0], first.name());
  EXPECT_EQ(images.publishers(), 1u);
}

TYPED_TEST_P(BusContract, MessageIsACopy) {
  const auto received = this->record(this->pair_.second(), "force");
  const auto publisher = this->pair_.first().template advertise<geometry_msgs::WrenchStamped>("force", 10);
  ASSERT_TRUE(this->connects(publisher));
  auto message = this->wrench(1);
  publisher.publish(message);
  message.wrench.force.z = 5;
  ASSERT_TRUE(this->pair_.serve([&] { return !received->forces.empty(); }));
  EXPECT_EQ(received->forces[0], 1);
}

TYPED_TEST_P(BusContract, LateSubscriberReceivesTheLastMessageOfALatchingPublisherOnly) {
  Bus &first = this->pair_.first(), &second = this->pair_.second();
  const auto latched = first.advertise<geometry_msgs::WrenchStamped>("latched", 10, true);
  const auto passing = first.advertise<geometry_msgs::WrenchStamped>("passing", 10);
  latched.publish(this->wrench(1));
  latched.publish(this->wrench(2));
  passing.publish(this->wrench(3));
  const auto of_latched = this->record(second, "latched"), of_passing = this->record(second, "passing");
  ASSERT_TRUE(this->connects(passing));
  passing.publish(this->wrench(4));
  // On a RosBus what was published just before may still be on its way.
  const auto ends_with = [](const auto& record, double force) {
    return !record->forces.empty() && record->forces.back() == force;
  };
  ASSERT_TRUE(this->pair_.serve([&] { return ends_with(of_latched, 2) && ends_with(of_passing, 4); }));
  EXPECT_TRUE(of_latched->raw.back().latched);
  EXPECT_FALSE(of_passing->raw.back().latched);
}

TYPED_TEST_P(BusContract, FullQueueDropsItsOldestMessages) {
  const auto publisher = this->pair_.first().template advertise<geometry_msgs::WrenchStamped>("force", 10);
  const auto witness = this->record(this->pair_.first(), "force");
  const auto received = this->record(this->pair_.second(), "force", 2, Serving::kDrives);  // served only in steps
  ASSERT_TRUE(this->connects(publisher));  // a process has one connection, however many subscriptions
  for (const double force : {1, 2, 3, 4, 5}) publisher.publish(this->wrench(force));
  ASSERT_TRUE(this->pair_.serve([&] { return witness->forces.size() == 5; }));
  bool stepped = false;
  ASSERT_TRUE(this->pair_.runSecond(
      0.01, [&](const ros::Time&) { stepped = true; }, [&] { return stepped; }));
  EXPECT_EQ(received->forces, (std::vector<double>{4, 5}));
}

TYPED_TEST_P(BusContract, SeveralPublishersAndTheirEnds) {
  Bus& first = this->pair_.first();
  const auto received = this->record(this->pair_.second(), "force");
  auto one = first.template advertise<geometry_msgs::WrenchStamped>("force", 10);
  auto other = this->pair_.second().template advertise<geometry_msgs::WrenchStamped>("force", 10);
  ASSERT_TRUE(this->connects(one));
  ASSERT_TRUE(this->connects(other));
  one.publish(this->wrench(1));
  other.publish(this->wrench(2));
  ASSERT_TRUE(this->pair_.serve([&] { return received->forces.size() == 2; }));
  EXPECT_GE(received->subscription.publishers(), 1u);
  one.shutdown();
  other.shutdown();
  EXPECT_TRUE(this->pair_.serve([&] { return received->subscription.publishers() == 0; }));
}

TYPED_TEST_P(BusContract, EndedSubscriptionReceivesNothing) {
  const auto received = this->record(this->pair_.second(), "force"),
             witness = this->record(this->pair_.second(), "force");
  const auto publisher = this->pair_.first().template advertise<geometry_msgs::WrenchStamped>("force", 10);
  ASSERT_TRUE(this->connects(publisher));
  received->subscription.shutdown();
  publisher.publish(this->wrench(1));
  ASSERT_TRUE(this->pair_.serve([&] { return !witness->forces.empty(); }));
  EXPECT_TRUE(received->forces.empty());
}

TYPED_TEST_P(BusContract, ServiceAnswersUntilItEnds) {
  Bus& first = this->pair_.first();
  BusHandle service = first.template advertiseService<std_srvs::Trigger>(
      "~ask",
      [](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        response.message = "yes";
        return true;
      },
      Serving::kOwnThread);
  std_srvs::Trigger call;
  ASSERT_TRUE(this->pair_.second().call(first.name() + "/ask", call));
  EXPECT_EQ(call.response.message, "yes");
  const BusHandle failing = first.template advertiseService<std_srvs::Trigger>(
      "~fail",
      [](std_srvs::Trigger::Request&, std_srvs::Trigger::Response&) -> bool { throw std::runtime_error("no answer"); },
      Serving::kOwnThread);
  EXPECT_FALSE(this->pair_.second().call(first.name() + "/fail", call)) << "the caller goes on";
  service.reset();
  EXPECT_FALSE(this->pair_.second().call(first.name() + "/ask", call));
}

TYPED_TEST_P(BusContract, ParametersAreYaml) {
  const Bus& bus = this->pair_.second();
  const YAML::Node all = bus.parameter("~");
  ASSERT_TRUE(all.IsMap());
  EXPECT_EQ(all["rate"].template as<int>(), 100);
  EXPECT_EQ(bus.parameter("~name").template as<std::string>(), "probe");
  EXPECT_EQ(bus.parameter("~map/deep").template as<double>(), 2.5);
  EXPECT_TRUE(bus.parameter("~flag").template as<bool>());
  EXPECT_EQ(bus.parameter("~list").size(), 2u);
  EXPECT_TRUE(bus.parameter("~absent").IsNull());
  EXPECT_TRUE(bus.parameter("/absent").IsNull());
  EXPECT_EQ(bus.parameter("/contract/text").template as<std::string>(), "of the session");
}

TYPED_TEST_P(BusContract, NamesResolve) {
  const Bus& bus = this->pair_.second();
  EXPECT_EQ(bus.resolve("needle/measured_cp"), "/needle/measured_cp");
  EXPECT_EQ(bus.resolve("/haptic/servo_cf"), "/haptic/servo_cf");
  EXPECT_EQ(bus.resolve("~tare"), bus.name() + "/tare");
  EXPECT_EQ(bus.resolve("cell/old"), "/cell/new");  // remapped
}

TYPED_TEST_P(BusContract, TimerCallsUntilItEnds) {
  Bus& second = this->pair_.second();
  int calls = 0, witness = 0;
  BusHandle timer = second.timer(0.01, [&] { ++calls; });
  const BusHandle other = second.timer(0.01, [&] { ++witness; });
  ASSERT_TRUE(this->pair_.serve([&] { return calls >= 3; }));
  timer.reset();
  const int before = calls;
  witness = 0;
  ASSERT_TRUE(this->pair_.serve([&] { return witness >= 3; }));
  EXPECT_EQ(calls, before);
}

TYPED_TEST_P(BusContract, WaitingForNoTimeHandlesWhatHasArrived) {
  const auto latched = this->pair_.first().template advertise<geometry_msgs::WrenchStamped>("at_once", 10, true);
  latched.publish(this->wrench(1));
  const auto received = this->record(this->pair_.second(), "at_once");
  EXPECT_TRUE(this->pair_.serve([&] {
    EXPECT_FALSE(this->pair_.second().waitUntil([] { return false; }, 0));
    return !received->forces.empty();
  }));
}

TYPED_TEST_P(BusContract, NodeStepsAtItsRateAndServesSampledMessagesBeforeAStep) {
  const auto publisher = this->pair_.first().template advertise<geometry_msgs::WrenchStamped>("force", 10);
  const auto received = this->record(this->pair_.second(), "force");
  ASSERT_TRUE(this->connects(publisher));
  publisher.publish(this->wrench(1));
  std::vector<ros::Time> steps;
  ASSERT_TRUE(this->pair_.runSecond(
      0.01, [&](const ros::Time& now) { steps.push_back(now); },
      [&] { return steps.size() >= 4 && !received->forces.empty(); }));
  for (std::size_t i = 1; i < steps.size(); ++i) EXPECT_LT(steps[i - 1], steps[i]);
}

TYPED_TEST_P(BusContract, DrivingMessageStartsAStep) {
  const auto publisher = this->pair_.first().template advertise<geometry_msgs::WrenchStamped>("force", 10);
  const auto received = this->record(this->pair_.second(), "force", 10, Serving::kDrives);
  ASSERT_TRUE(this->connects(publisher));
  int steps = 0, with_message = 0;
  // The first step is at once, the second would be in 1000 s.
  ASSERT_TRUE(this->pair_.runSecond(
      1000,
      [&](const ros::Time&) {
        ++steps;
        with_message += received->forces.empty() ? 0 : 1;
        if (steps == 1) publisher.publish(this->wrench(1));
      },
      [&] { return steps == 2; }));
  EXPECT_EQ(with_message, 1);
}

TYPED_TEST_P(BusContract, NodeThatStopsEndsInGoodOrder) {
  Bus& second = this->pair_.second();
  int ends = 0, steps = 0;
  second.onEnd([&] { ++ends; });
  ASSERT_TRUE(this->pair_.runSecond(
      0.01,
      [&](const ros::Time&) {
        ++steps;
        second.stop();
      },
      [&] { return ends > 0; }));
  EXPECT_EQ(steps, 1);
  EXPECT_EQ(ends, 1);
  EXPECT_FALSE(second.isRunning());
}

REGISTER_TYPED_TEST_SUITE_P(BusContract, MessageArrivesWithSenderTimeAndNumber, ImageArrivesWithItsSender,
                            MessageIsACopy, LateSubscriberReceivesTheLastMessageOfALatchingPublisherOnly,
                            FullQueueDropsItsOldestMessages, SeveralPublishersAndTheirEnds,
                            EndedSubscriptionReceivesNothing, ServiceAnswersUntilItEnds, ParametersAreYaml,
                            NamesResolve, TimerCallsUntilItEnds, WaitingForNoTimeHandlesWhatHasArrived,
                            NodeStepsAtItsRateAndServesSampledMessagesBeforeAStep, DrivingMessageStartsAStep,
                            NodeThatStopsEndsInGoodOrder);

}  // namespace microinjection
