#include "nodes/bus/local_bus.h"

#include "bus_contract.h"

namespace microinjection {
namespace {

class LocalPair : public BusPair {
 public:
  LocalPair() {
    network_.setParameter("/contract/text", YAML::Node("of the session"));
    first_ = network_.connect("/first", YAML::Node(YAML::NodeType::Map));
    second_ = network_.connect("/second", YAML::Load(kParameters), {{"/cell/old", "/cell/new"}});
  }

  Bus& first() override { return *first_; }
  Bus& second() override { return *second_; }
  bool serve(const std::function<bool()>& done) override {
    return advance(done, [this] {
      first_->run();
      // What drives the second node waits for its steps.
      if (second_->driving().empty()) second_->run();
    });
  }
  bool runSecond(double period, const Step& step, const std::function<bool()>& done) override {
    second_->setStep(period, step);
    return advance(done, [this] {
      if (second_->isRunning()) second_->run();
      if (!second_->isRunning()) second_->end();
    });
  }

 private:
  /// At the most a second of virtual time.
  bool advance(const std::function<bool()>& done, const std::function<void()>& run) {
    for (int i = 0; i < 1000 && !done(); ++i) {
      run();
      network_.setTime(network_.now() + ros::Duration(0, 1000000));
    }
    return done();
  }

  LocalNetwork network_{ros::Time(10)};
  std::unique_ptr<LocalBus> first_, second_;
};

using Wrench = geometry_msgs::WrenchStamped;

Wrench wrench(double force) {
  Wrench message;
  message.wrench.force.z = force;
  return message;
}

class LocalNetworkTest : public testing::Test {
 protected:
  LocalNetworkTest() {
    received_ = receiver_->subscribe<Wrench>(
        "force", 10, [this](const Delivery<Wrench>& delivery) { forces_.push_back(delivery.message->wrench.force.z); });
  }
  std::vector<double> sent(double force) {
    publisher_.publish(wrench(force));
    receiver_->run();
    return forces_;
  }

  LocalNetwork network_{ros::Time(10)};
  std::unique_ptr<LocalBus> sender_ = network_.connect("/sender", YAML::Node(YAML::NodeType::Map)),
                            receiver_ = network_.connect("/receiver", YAML::Node(YAML::NodeType::Map));
  std::vector<double> forces_;
  Subscription received_;
  Publisher<Wrench> publisher_ = sender_->advertise<Wrench>("force", 10);
};

TEST_F(LocalNetworkTest, TopicHasOneType) {
  const auto other = sender_->advertise<std_msgs::Bool>("force", 10);
  EXPECT_EQ(other.subscribers(), 0u);
  other.publish(std_msgs::Bool());
  EXPECT_EQ(sent(1), std::vector<double>{1});
}

TEST_F(LocalNetworkTest, LateSubscriberReceivesOnlyTheLastMessageOfALatchingPublisher) {
  const auto latched = sender_->advertise<Wrench>("latched", 10, true);
  latched.publish(wrench(1));
  latched.publish(wrench(2));
  std::vector<double> late;
  const Subscription subscription = receiver_->subscribe<Wrench>(
      "latched", 10, [&](const Delivery<Wrench>& delivery) { late.push_back(delivery.message->wrench.force.z); });
  receiver_->run();
  EXPECT_EQ(late, std::vector<double>{2});
}

TEST_F(LocalNetworkTest, MessageIsLost) {
  network_.alter("/force", [](const Passage&) { return std::vector<Passage>(); });
  EXPECT_EQ(sent(1), std::vector<double>{});
  network_.alter("/force", {});
  EXPECT_EQ(sent(2), std::vector<double>{2});
}

TEST_F(LocalNetworkTest, MessageIsDoubled) {
  network_.alter("/force", [](const Passage& passage) { return std::vector<Passage>{passage, passage}; });
  EXPECT_EQ(sent(1), (std::vector<double>{1, 1}));
}

TEST_F(LocalNetworkTest, MessageIsLate) {
  network_.alter("/force", [](Passage passage) {
    passage.delay = 0.02;
    return std::vector<Passage>{passage};
  });
  EXPECT_EQ(sent(1), std::vector<double>{});
  ASSERT_TRUE(network_.nextArrival());
  EXPECT_EQ(*network_.nextArrival(), ros::Time(10, 20000000));
  network_.setTime(*network_.nextArrival());
  network_.deliverDue();
  receiver_->run();
  EXPECT_EQ(forces_, std::vector<double>{1});
}

TEST_F(LocalNetworkTest, MessageIsDamaged) {
  network_.alter("/force", [](Passage passage) {
    passage.message = boost::make_shared<Wrench>(wrench(NAN));
    return std::vector<Passage>{passage};
  });
  EXPECT_TRUE(std::isnan(sent(1).back()));
}

TEST_F(LocalNetworkTest, KilledNodeIsNotHeard) {
  sender_->disconnect();
  EXPECT_EQ(sent(1), std::vector<double>{});
}

TEST_F(LocalNetworkTest, TimeIsThatOfRos) {
  EXPECT_EQ(ros::Time::now(), ros::Time(10));
  network_.setTime(ros::Time(11));
  EXPECT_EQ(ros::Time::now(), ros::Time(11));
  EXPECT_EQ(sender_->now(), ros::Time(11));
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(LocalBus, BusContract, LocalPair);

}  // namespace microinjection
