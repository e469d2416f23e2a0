// A haptic device gets zero force, again and again, when its bridge or adapter is silent, and only then.

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>

#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/omni_messages.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

constexpr double kPatience = 0.05;  // s, of config/haptic

Eigen::Vector3d forceOf(const geometry_msgs::WrenchStamped& message) { return toVector(message.wrench.force); }
Eigen::Vector3d forceOf(const OmniFeedback& message) { return toVector(message.force); }
Eigen::Vector3d forceOf(const DeviceFeedback& message) { return toVector(message.force); }

template <typename Message>
Message pressing() {
  Message message;
  message.force.z = 1.5;
  return message;
}
template <>
geometry_msgs::WrenchStamped pressing() {
  return wrenchMessage(0, 0, 1.5, "haptic");
}

void expectComplete(const DeviceFeedback& message) {
  EXPECT_EQ(message.lock.size(), 3U) << "its driver reads three without asking";
}
void expectComplete(const geometry_msgs::WrenchStamped& message) { EXPECT_FALSE(message.header.stamp.isZero()); }
void expectComplete(const OmniFeedback&) {}

/// "bridge" is a node of the test; it tells the forces that the watchdog waits for.
template <typename Message>
class WatchedForce {
 public:
  WatchedForce(const std::string& parameters, std::string topic)
      : topic_(std::move(topic)), bridge_(session_.addTestNode("bridge")) {
    session_.world().hear<Message>(topic_);
    bridge_.publisher<Message>(topic_);
    session_.add("force_watchdog", "force_watchdog", YAML::Load(parameters));
  }

  void expectNothingFor(double seconds) { EXPECT_EQ(saidWithin(seconds).size(), 0U); }
  void expectZeroAgainAndAgain() {
    const auto said = saidWithin(0.15);
    EXPECT_GE(said.size(), 29U) << "200 times a second";
    for (const auto& message : said) {
      EXPECT_EQ(forceOf(*message), Eigen::Vector3d::Zero());
      expectComplete(*message);
    }
  }
  void expectZeroOnlyInSilence() {
    for (int i = 0; i < 3; ++i) {
      bridge_.say(topic_, pressing<Message>());
      expectNothingFor(0.98 * kPatience);
      EXPECT_GT(saidWithin(0.14 * kPatience).size(), 0U) << "it looks each 5 ms";
      expectZeroAgainAndAgain();
    }
  }
  Probe<Message>& heard() { return session_.world().template hear<Message>(topic_); }

 private:
  /// What the watchdog says in the next `seconds`.
  std::vector<boost::shared_ptr<const Message>> saidWithin(double seconds) {
    const ros::Time start = session_.now();
    session_.run(seconds);
    std::vector<boost::shared_ptr<const Message>> said;
    for (std::size_t i = 0; i < heard().count(); ++i) {
      if (heard().senders()[i] == "/force_watchdog" && heard().arrivals()[i] > start) said.push_back(heard().all()[i]);
    }
    return said;
  }

  VirtualSession session_;
  std::string topic_;
  TestNode& bridge_;
};

TEST(ForceWatchdog, GivesZeroForceBeforeAndAfterTheBridge) {
  WatchedForce<geometry_msgs::WrenchStamped> force("{}", "haptic/servo_cf");
  force.expectZeroAgainAndAgain();
  force.expectZeroOnlyInSilence();
  const auto& last = *force.heard().newest();
  EXPECT_EQ(last.header.frame_id, "haptic") << "as the bridge's";
  EXPECT_EQ(last.header.stamp, force.heard().arrivals().back());
}

TEST(ForceWatchdog, GivesZeroForceToAnOmni) {
  WatchedForce<OmniFeedback> force("{kind: omni}", "phantom/force_feedback");
  force.expectZeroAgainAndAgain();
  force.expectZeroOnlyInSilence();
}

TEST(ForceWatchdog, GivesZeroForceToAGeomagic) {
  WatchedForce<DeviceFeedback> force("{kind: geomagic, device: Left}", "Left/force_feedback");
  force.expectZeroAgainAndAgain();
  force.expectZeroOnlyInSilence();
}

/// The first force of all frees an arm, which nothing holds yet.
TEST(ForceWatchdog, GivesAnArmNoForceBeforeItsAdapterDoes) {
  WatchedForce<geometry_msgs::WrenchStamped> force("{device: /MTMR, force: body/servo_cf, from_start: false}",
                                                   "MTMR/body/servo_cf");
  force.expectNothingFor(0.5);
  force.expectZeroOnlyInSilence();
}

}  // namespace
}  // namespace microinjection
