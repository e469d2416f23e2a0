#include "operation/link/wave_port.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "operation/link/link_emulator.h"
#include "operation/link/link_loop.h"

namespace microinjection {
namespace {

TeleoperationPacket packet(std::uint64_t sequence, double integral, double energy) {
  return {sequence, 0, Eigen::Vector3d(0, 0, integral), energy};
}

TEST(WavePlayout, GivesBackWhatWasSentWhateverWasLost) {
  WavePlayout playout;
  EXPECT_FALSE(playout.advance());
  const auto wave = [](int i) { return std::sin(0.02 * i); };
  double sent = 0, sent_energy = 0, played = 0, energy = 0;
  for (int i = 1; i <= 1000; ++i) {
    sent += wave(i) * kStep;
    sent_energy += 0.5 * wave(i) * wave(i) * kStep;
    if (i % 3 == 0 || i > 997) playout.receive(packet(i, sent, sent_energy));
    const auto advance = playout.advance();
    if (!advance) continue;
    played += advance->integral.z();
    energy += 0.5 * std::pow(advance->integral.z() / kStep, 2) * kStep;
    EXPECT_LE(energy, sent_energy + 1e-12) << "at " << i;
  }
  while (playout.buffered() > 0) {
    const auto advance = playout.advance();
    played += advance->integral.z();
    energy += 0.5 * std::pow(advance->integral.z() / kStep, 2) * kStep;
  }
  EXPECT_NEAR(played, sent, 1e-12);
  EXPECT_LE(energy, sent_energy);
  EXPECT_GT(energy, 0.99 * sent_energy);
}

TEST(WavePlayout, WaitsWhenLateAndPlaysOffWhatItDoesNotNeed) {
  WavePlayout playout;
  for (int i = 1; i <= 100; ++i) playout.receive(packet(i, i, 0));  // a burst, then one a period
  for (int i = 101; i < 60000; ++i) {
    playout.receive(packet(i, i, 0));
    const auto advance = playout.advance();
    ASSERT_LE(advance->integral.z(), 1.0101) << "no leap";
  }
  EXPECT_LT(playout.buffered(), 4);
  for (int i = 0; i < 10; ++i) playout.advance();
  EXPECT_TRUE(playout.advance()->underrun);
}

TEST(WavePlayout, DoesNotBeginInTheMidst) {
  WavePlayout playout;
  playout.receive(packet(5000, 7.0, 1.0));
  EXPECT_FALSE(playout.advance());
}

/// Lets a wave (sqrt(W)) that stops, with packets that are late by `stall` periods just then, come out.
void stopWhileLate(double wave, int stall) {
  const WaveReceiverConfig config;
  WaveReceiver receiver(config);
  double sent = 0, energy = 0, let_out = 0, held = 0;
  for (int i = 1; i <= 4000; ++i) {
    const double now = i <= 1000 ? wave : 0;
    sent += now * kStep;
    energy += 0.5 * now * now * kStep;
    if (i <= 1000 || i > 1000 + stall) receiver.receive(packet(i, sent, energy));
    const double out = receiver.step(0.1, kStep).z() * kStep;
    let_out += out;
    if (i > 1000 && i <= 1000 + stall) held += out;
  }
  EXPECT_GT(held, 0) << wave << ' ' << stall;
  EXPECT_NEAR(let_out, sent, 1e-3 * held) << wave << ' ' << stall;
  EXPECT_GE(receiver.margin(), -config.reserve) << wave << ' ' << stall;
}

TEST(WaveReceiver, GivesBackWhatItHeldTooLongAlthoughNothingMoreComes) {
  for (const int stall : {50, 100, 290}) {
    for (const double wave : {0.05, 0.1, 0.2, 0.5, 2.0}) stopWhileLate(wave, stall);
  }
}

/// A hand that is held at a depth over a bad link on a spring, without any bridge.
struct Held {
  double force, needle_force, needle, margin;
};

Held press(const LinkConditions& conditions, double stiffness, double depth) {
  WaveConfig config;
  WaveLeader leader(config);
  WaveFollower follower(config);
  leader.reset(Eigen::Vector3d::Zero());
  follower.reset(Eigen::Vector3d::Zero());
  LinkEmulator<TeleoperationPacket> forward(conditions), back(conditions);
  Held held{0, 0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const double now = i * kStep;
    for (const auto& one : back.receive(now)) leader.receive(one);
    const double force = leader.step({0, 0, -depth * std::min(1.0, now)}, kStep).z();
    forward.send(leader.packet(), now);
    for (const auto& one : forward.receive(now)) follower.receive(one);
    const double touched = stiffness * std::max(0.0, -follower.position().z());
    follower.step({0, 0, touched}, kStep);
    back.send(follower.packet(), now);
    held.margin = std::min({held.margin, leader.margin(), follower.margin()});
    if (i >= 19000) {
      held.force += force / 1000;
      held.needle_force += touched / 1000;
      held.needle += follower.position().z() / 1000;
    }
  }
  return held;
}

TEST(WavePort, AHeldForcePassesAndTheChannelIsASpring) {
  // At rest the needle is behind by f T / b, T from one side's wave to the other's: delay, two periods, and the filters
  // (their time constant; the highpass_loss's share of a round trip).
  const WaveConfig config;
  for (const double delay : {0.0, 0.02, 0.1, 0.2}) {
    const Held held = press({delay, 0, 0, 1}, 60, 0.02);
    EXPECT_NEAR(held.force / held.needle_force, 1, 2e-3) << delay;
    const double lag = delay + config.receiver.filter_time + config.receiver.highpass_loss * 2 * (delay + kStep);
    const double expected = 0.02 / (1 / 60.0 + lag / config.impedance + 1 / config.stiffness);
    EXPECT_NEAR(held.force / expected, 1, 0.02) << delay;
  }
}

TEST(WavePort, LossAndJitterTakeNothingOffAHeldForce) {
  for (const double delay : {0.0, 0.02, 0.1, 0.2}) {
    for (const double loss : {0.2, 0.6}) {
      const Held held = press({delay, std::max(2e-3, delay / 2), loss, 3}, 60, 0.02);
      EXPECT_NEAR(held.force / held.needle_force, 1, 0.02) << delay << ' ' << loss;
      EXPECT_GT(held.force, 0.6 * 1.2 / (1 + 60 * delay * 2 / 20)) << delay << ' ' << loss;
      EXPECT_GE(held.margin, -WaveReceiverConfig{}.reserve) << delay << ' ' << loss;
    }
  }
}

TEST(WavePort, AMovingHandFeelsTheMatchingAndNoWaveComesBack) {
  const WaveConfig config;
  WaveLeader leader(config);
  WaveFollower follower(config);
  leader.reset(Eigen::Vector3d::Zero());
  follower.reset(Eigen::Vector3d::Zero());
  LinkEmulator<TeleoperationPacket> forward({0.1, 0, 0, 1}), back({0.1, 0, 0, 1});
  const double speed = 0.02;  // m/s
  for (int i = 0; i < 2000; ++i) {
    const double now = i * kStep;
    for (const auto& one : back.receive(now)) leader.receive(one);
    const double force = leader.step({0, 0, -speed * now}, kStep).z();
    forward.send(leader.packet(), now);
    for (const auto& one : forward.receive(now)) follower.receive(one);
    follower.step(Eigen::Vector3d::Zero(), kStep);
    back.send(follower.packet(), now);
    // The spring between hand and waves is there at once, their answer never.
    if (i > 150) EXPECT_NEAR(force, config.matching * config.impedance * speed, 0.02 * config.impedance * speed) << i;
  }
}

TEST(WavePort, TheChannelGivesNoMoreThanItTook) {
  // Shaken by a hand, against a spring: the energy taken at both ports, at any time.
  const WaveConfig config;
  for (const double delay : {0.0, 0.02, 0.1, 0.2}) {
    for (const double loss : {0.0, 0.2, 0.6}) {
      const LinkConditions conditions{delay, std::max(2e-3, delay / 2), loss, 5};
      WaveLeader leader(config);
      WaveFollower follower(config);
      leader.reset(Eigen::Vector3d::Zero());
      follower.reset(Eigen::Vector3d::Zero());
      LinkEmulator<TeleoperationPacket> forward(conditions), back(conditions);
      double energy = 0, force = 0, hand = 0, least = 0;
      for (int i = 0; i < 8000; ++i) {
        const double now = i * kStep;
        const double z = 0.005 - 0.02 * std::sin(now * 9) - 0.005 * std::cos(now * 23);
        if (i > 0) energy -= force * (z - hand);
        hand = z;
        if (i == 0) leader.reset({0, 0, z});
        for (const auto& one : back.receive(now)) leader.receive(one);
        force = leader.step({0, 0, z}, kStep).z();
        forward.send(leader.packet(), now);
        for (const auto& one : forward.receive(now)) follower.receive(one);
        const double before = follower.position().z(), touched = 200 * std::max(0.0, -before);
        follower.step({0, 0, touched}, kStep);
        energy += touched * (follower.position().z() - before);
        back.send(follower.packet(), now);
        least = std::min(least, energy);
      }
      // Twice the reserve, and what a force that is held for a period gives on the way back.
      EXPECT_GT(least, -2 * config.receiver.reserve - 5e-4) << delay << ' ' << loss;
      EXPECT_GT(energy, 0) << delay << ' ' << loss;
    }
  }
}

}  // namespace
}  // namespace microinjection
