#include <random>

#include "led_session.h"

namespace microinjection {
namespace {

/// Messages that are late, lost, repeated, out of order or wrong, while a hand leads the needle up and down.
class MessagesTest : public testing::Test {
 protected:
  static constexpr double kWay = 5e-6, kSpeed = 20e-6;  // m, m/s, of the needle

  MessagesTest() {
    chain_.hand().sway(kWay / LedHand::kScale, kSpeed / LedHand::kScale);
    session().run(0.1);
    EXPECT_GT(chain_.needle().span(), 1e-6);
  }

  VirtualSession& session() { return chain_.session(); }
  void alter(const std::string& topic, Alteration alteration) {
    session().executive().network().alter(topic, std::move(alteration));
  }
  /// The needle's way from now on, for a period of the hand's motion and more.
  Track run(double seconds = 0.6) {
    begin_ = session().now().toSec();
    session().run(seconds);
    return chain_.needle().since(begin_);
  }
  /// Longest way between two messages.
  static double leap(const Track& needle) {
    double longest = 0;
    for (std::size_t i = 1; i < needle.values.size(); ++i)
      longest = std::max(longest, (needle.values[i] - needle.values[i - 1]).norm());
    return longest;
  }
  /// The whole way, never faster than the hand by much, and nobody has held.
  void expectFollows(const Track& needle, double leap_limit = 2 * kSpeed * 1e-3) {
    EXPECT_NEAR(needle.span(), kWay, 0.02 * kWay);
    EXPECT_LT(leap(needle), leap_limit);
    EXPECT_EQ(chain_.holdReasons("controller/loop_state", begin_), "");
    EXPECT_EQ(chain_.holdReasons("haptic/loop_state", begin_), "");
    chain_.expectEnabled();
  }
  void expectRests(const Track& needle) {
    EXPECT_LT(needle.since(begin_ + 0.2).span(), LedSession::kStill);
    chain_.expectEnabled();
  }

  LedSession chain_;
  double begin_ = 0;
};

TEST_F(MessagesTest, SetPointsThatComeTwice) {
  alter("/needle/servo_cp", [](const Passage& passage) { return std::vector<Passage>{passage, passage}; });
  expectFollows(run());
}

TEST_F(MessagesTest, SetPointsThatAreLate) {
  alter("/needle/servo_cp", [](Passage passage) {
    passage.delay = 0.02;
    return std::vector<Passage>{passage};
  });
  expectFollows(run());
}

TEST_F(MessagesTest, SetPointsOfWhichAThirdIsLost) {
  alter("/needle/servo_cp", [random = std::mt19937(1)](const Passage& passage) mutable {
    return random() % 10 < 3 ? std::vector<Passage>{} : std::vector<Passage>{passage};
  });
  expectFollows(run(), 20 * kSpeed * 1e-3);
}

TEST_F(MessagesTest, SetPointsThatAreStaleMoveNothing) {
  alter("/needle/servo_cp", [](Passage passage) {
    passage.delay = 0.15;  // past command_timeout
    return std::vector<Passage>{passage};
  });
  expectRests(run());
}

TEST_F(MessagesTest, TargetsWithAnOldStampMoveNothing) {
  alter("/teleop/servo_cp", [](Passage passage) {
    auto old = boost::make_shared<geometry_msgs::PoseStamped>(
        *boost::static_pointer_cast<const geometry_msgs::PoseStamped>(passage.message));
    if (!old->header.stamp.isZero()) old->header.stamp -= ros::Duration(0.1);
    passage.message = old;
    return std::vector<Passage>{passage};
  });
  expectRests(run());
  EXPECT_NE(chain_.holdReasons("controller/loop_state", begin_).find("no valid target"), std::string::npos);
}

TEST_F(MessagesTest, ForceThatIsNotFiniteNowAndThenGoesNoFurther) {
  alter("/cell/predicted_cf", [count = 0](Passage passage) mutable {
    if (++count % 10 != 0) return std::vector<Passage>{passage};
    auto wrong = boost::make_shared<geometry_msgs::WrenchStamped>(
        *boost::static_pointer_cast<const geometry_msgs::WrenchStamped>(passage.message));
    wrong->wrench.force.z = NAN;
    passage.message = wrong;
    return std::vector<Passage>{passage};
  });
  session().world().hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
  const Track needle = run();
  for (const Track& said : {needle, chain_.setpoint(), chain_.force()}) {
    for (const auto& value : said.values) ASSERT_TRUE(value.allFinite());
  }
  for (const auto& target : chain_.target().all()) ASSERT_TRUE(toVector(target->pose.position).allFinite());
  for (const auto& measured : session().world().hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf").all())
    ASSERT_TRUE(toVector(measured->wrench.force).allFinite());
  // Each of them holds the needle, and none for longer than it lasts.
  EXPECT_GT(needle.span(), 0.7 * kWay);
  EXPECT_LT(needle.span(), 0.98 * kWay);
  EXPECT_LT(leap(needle), 2 * kSpeed * 1e-3);
  chain_.expectEnabled();
}

TEST_F(MessagesTest, PosesOfTheHandOutOfOrder) {
  alter("/haptic/measured_cp", [count = 0](Passage passage) mutable {
    if (++count % 2 == 0) passage.delay = 1.5e-3;  // after the next one
    return std::vector<Passage>{passage};
  });
  expectFollows(run(), 4 * kSpeed * 1e-3);
}

TEST_F(MessagesTest, ABridgeThatIsLateIsMadeUpFor) {
  session().executive().delay("haptic_bridge", 0.04);
  expectFollows(run(), 200e-6 * 1e-3 + LedSession::kStill);  // speed_limit
}

TEST_F(MessagesTest, ABridgeThatIsLateByMoreThanATimeOutIsHeldOnceAndFollowedFromThere) {
  session().executive().delay("haptic_bridge", 0.06);
  const Track needle = run(0.3);
  EXPECT_NE(chain_.holdReasons("controller/loop_state", begin_).find("no valid target"), std::string::npos);
  EXPECT_LT(leap(needle), 2 * kSpeed * 1e-3);
  expectFollows(run());
}

TEST_F(MessagesTest, AControllerThatIsLateIsMadeUpFor) {
  for (const double late : {0.04, 0.06}) {
    SCOPED_TRACE(late);
    session().executive().delay("injection_controller", late);
    expectFollows(run(), 200e-6 * 1e-3 + LedSession::kStill);  // speed_limit
  }
}

TEST_F(MessagesTest, ARigThatIsLateIsWaitedFor) {
  session().executive().delay("micromanipulator", 0.06);
  const Track needle = run(0.3);
  EXPECT_EQ(chain_.holdReasons("controller/loop_state", begin_), "the needle does not follow its set-point");
  EXPECT_LT(leap(needle), 0.06 * kSpeed) << "farther than the set-point has gone";
  expectFollows(run());
}

/// Which of two poses is the needle's, nobody can know.
TEST_F(MessagesTest, TwoRigsOnOneSetPointHoldTheNeedle) {
  session().add("second_rig", "micromanipulator", session().parameters("micromanipulator"));
  session().run(0.5);
  expectRests(run());
  EXPECT_NE(chain_.holdReasons("controller/loop_state", begin_).find("no valid needle position"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
