#include "operation/teleoperation/two_port.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "operation/teleoperation/link_emulator.h"

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s

TeleoperationPacket packet(std::uint64_t sequence, double z, double energy) {
  return {sequence, 0, Eigen::Vector3d(0, 0, z), energy};
}

TEST(LinkEmulator, DelaysShufflesAndLosesAsToldAndRepeatably) {
  LinkConditions conditions{0.02, 0.01, 0.25, 7};
  const auto run = [&] {
    LinkEmulator<int> link(conditions);
    std::vector<std::pair<int, int>> arrived;
    for (int now = 0; now < 4100; ++now) {
      if (now < 4000) link.send(now, now * kStep);
      for (int sent : link.receive(now * kStep)) arrived.push_back({sent, now});
    }
    return arrived;
  };
  const auto arrived = run();
  EXPECT_NEAR(arrived.size(), 3000, 5 * std::sqrt(4000 * 0.25 * 0.75));
  bool overtaken = false;
  int last = -1;
  double delays = 0;
  for (const auto& [sent, now] : arrived) {
    EXPECT_GE(now - sent, 20);
    EXPECT_LE(now - sent, 31);
    delays += now - sent;
    overtaken = overtaken || sent < last;
    last = sent;
  }
  EXPECT_NEAR(delays / arrived.size(), 25.5, 0.3);
  EXPECT_TRUE(overtaken);
  EXPECT_EQ(run(), arrived);
  conditions.seed = 8;
  EXPECT_NE(run(), arrived);
}

TEST(PacketInbox, KeepsTheNewestValueAndTheLargestEnergy) {
  PacketInbox inbox;
  EXPECT_FALSE(inbox.value(1));
  inbox.receive(packet(5, 0.5, 2.0));
  inbox.receive(packet(4, 0.4, 1.5));  // late
  inbox.receive(packet(5, 0.9, 2.0));  // repeated
  EXPECT_EQ(inbox.value(1)->z(), 0.5);
  EXPECT_EQ(inbox.energy(), 2.0);
  inbox.age(0.5);
  EXPECT_TRUE(inbox.value(0.5));
  inbox.age(0.01);
  EXPECT_FALSE(inbox.value(0.5)) << "past its time-out";
  inbox.receive(packet(4, 0.4, 1.5));
  EXPECT_FALSE(inbox.value(0.5)) << "a late packet is no news";
  inbox.receive(packet(6, 0.6, 2.5));
  EXPECT_EQ(inbox.value(0.5)->z(), 0.6);
}

TEST(LeaderPort, GivesNoMoreThanTheOtherSideTookIn) {
  TwoPortConfig config;
  LeaderPort leader(config);
  leader.receive(packet(1, 1.0, 5e-3));  // 1 N outwards, 5 mJ behind it
  double z = 0, given = 0;
  for (int i = 0; i < 2000; ++i) {
    leader.receive(packet(2 + i, 1.0, 5e-3));
    const auto force = leader.step({0, 0, z}, kStep);
    given += force->z() * 0.1 * kStep;
    z += 0.1 * kStep;
  }
  EXPECT_LE(leader.energyOut(), 5e-3 + config.reserve);
  EXPECT_GT(leader.energyOut(), 4e-3) << "what is there must come out";
  EXPECT_NEAR(given, leader.energyOut(), 1e-3);
}

TEST(LeaderPort, RendersNothingWithoutNews) {
  TwoPortConfig config;
  LeaderPort leader(config);
  EXPECT_FALSE(leader.step(Eigen::Vector3d::Zero(), kStep));
  leader.receive(packet(1, 1.0, 0));
  const int steps = static_cast<int>(config.timeout / kStep);
  int trusted = 0;
  for (int i = 0; i < 2 * steps; ++i) trusted += leader.step(Eigen::Vector3d::Zero(), kStep) ? 1 : 0;
  EXPECT_NEAR(trusted, steps, 1);
}

TEST(FollowerPort, HoldsWithoutNews) {
  TwoPortConfig config;
  FollowerPort follower(config);
  EXPECT_FALSE(follower.step(Eigen::Vector3d::Zero(), kStep));
  follower.receive(packet(1, 0.01, 0));
  EXPECT_EQ(follower.step(Eigen::Vector3d::Zero(), kStep)->z(), 0.01);
  const int steps = static_cast<int>(config.timeout / kStep);
  for (int i = 0; i < steps + 1; ++i) follower.step(Eigen::Vector3d::Zero(), kStep);
  EXPECT_FALSE(follower.step(Eigen::Vector3d::Zero(), kStep));
}

TEST(FollowerPort, MovesFreelyInFreeMotionAndMakesUpForLoss) {
  TwoPortConfig config;
  FollowerPort follower(config);
  follower.receive(packet(1, 0, 0));
  follower.step(Eigen::Vector3d::Zero(), kStep);
  follower.receive(packet(50, -0.003, 0));  // 48 lost
  follower.step(Eigen::Vector3d::Zero(), kStep);
  EXPECT_NEAR(follower.position().z(), -config.speed_limit * kStep, 1e-12) << "no leap";
  for (int i = 0; i < 20; ++i) follower.step(Eigen::Vector3d::Zero(), kStep);
  EXPECT_EQ(follower.position().z(), -0.003);
}

TEST(FollowerPort, PressesInOnlyWithEnergyThatTheLeaderPutIn) {
  TwoPortConfig config;
  FollowerPort follower(config);
  const auto press = [&](double energy, std::uint64_t sequence) {
    for (int i = 0; i < 500; ++i) {
      follower.receive(packet(sequence + i, -0.05, energy));
      follower.step({0, 0, 100 * std::max(0.0, -follower.position().z())}, kStep);
    }
    const double depth = -follower.position().z();
    return 0.5 * 100 * depth * depth;  // J in the spring
  };
  follower.receive(packet(1, 0, 0));
  follower.step(Eigen::Vector3d::Zero(), kStep);
  EXPECT_LT(press(0, 2), config.reserve);
  const double with = press(0.02, 1000);
  EXPECT_LT(with, 0.02 + config.reserve);
  EXPECT_GT(with, 0.019) << "as soon as there is energy it goes where it was told";
  // Out again: nothing keeps it, and what the spring gives back is counted.
  for (int i = 0; i < 500; ++i) {
    follower.receive(packet(2000 + i, 0.01, 0.02));
    follower.step({0, 0, 100 * std::max(0.0, -follower.position().z())}, kStep);
  }
  EXPECT_EQ(follower.position().z(), 0.01);
  EXPECT_NEAR(follower.energyIn(), with, 0.02 * with);
}

/// Leader shaken against a spring over a bad link; returns the least margins of both directions.
double leastMargin(bool enabled, const LinkConditions& conditions) {
  TwoPortConfig config;
  config.enabled = enabled;
  LeaderPort leader(config);
  FollowerPort follower(config);
  LinkEmulator<TeleoperationPacket> forward(conditions), back(conditions);
  double least = 0;
  for (int i = 0; i < 8000; ++i) {
    const double now = i * kStep;
    for (const auto& one : back.receive(now)) leader.receive(one);
    leader.step({0, 0, 0.005 - 0.02 * std::sin(now * 9)}, kStep);
    forward.send(leader.packet(), now);
    for (const auto& one : forward.receive(now)) follower.receive(one);
    follower.step({0, 0, 200 * std::max(0.0, -follower.position().z())}, kStep);
    back.send(follower.packet(), now);
    least = std::min({least, leader.margin(), follower.margin()});
  }
  return least;
}

TEST(TwoPort, IsPassiveWithDelayJitterAndLossAndIsNotWithoutControl) {
  const double reserve = TwoPortConfig{}.reserve;
  for (const double delay : {0.0, 0.02, 0.1, 0.2}) {
    for (const double loss : {0.0, 0.2, 0.6}) {
      const LinkConditions conditions{delay, delay / 2, loss, 3};
      EXPECT_GT(leastMargin(true, conditions), -reserve) << delay << ' ' << loss;
      if (delay > 0) {
        EXPECT_LT(leastMargin(false, conditions), -10 * reserve) << delay << ' ' << loss;
      }
    }
  }
}

}  // namespace
}  // namespace microinjection
