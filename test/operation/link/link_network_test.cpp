// Both ends of the link with a network between: a fifth of the packets is lost.
#include <gtest/gtest.h>

#include <algorithm>

#include "operation/link/link_emulator.h"
#include "operation/link/link_follower.h"
#include "operation/link/link_leader.h"
#include "operation/link/link_loop.h"

namespace microinjection {
namespace {

constexpr double kGain = 2e5;                    // 1, newtons at the hand per newton at the tip
constexpr double kSpeed = 0.03;                  // m/s, of the hand
constexpr double kMean = 0.06, kLatest = 0.075;  // s, one way
const LinkConditions kNetwork{2 * kMean - kLatest, 2 * (kLatest - kMean), 0.2, 1};

/// A hand that goes where it is told whatever it feels, which damps nothing, and a needle that touches a spring.
class LinkNetwork : public testing::TestWithParam<unsigned> {
 protected:
  LinkNetwork() {
    for (int i = 0; i < 1000; ++i) step(0);
  }

  static LinkConditions network(unsigned more) {
    LinkConditions conditions = kNetwork;
    conditions.seed = GetParam() + more;
    return conditions;
  }

  /// One period with the hand at z (m), which makes the energy's balance at the hand.
  void step(double z) {
    now_ += kStep;
    energy_ -= force_ * (z - hand_);
    hand_ = z;
    for (const LinkPacket& packet : to_hand_.receive(now_)) leader_.receive(packet);
    const auto force = leader_.step(kStep);
    force_ = force ? force->z() : 0;
    leader_.setTarget(force ? std::optional<Eigen::Vector3d>(Eigen::Vector3d(0, 0, kScale * z)) : std::nullopt);
    to_rig_.send(leader_.packet(), now_);
    for (const LinkPacket& packet : to_rig_.receive(now_)) follower_.receive(packet);
    const auto goal =
        follower_.step({Eigen::Vector3d(0, 0, kScale * needle_), Eigen::Vector3d(0, 0, touched() / kGain)}, kStep);
    to_hand_.send(follower_.packet(), now_);
    if (goal) needle_ = goal->z() / kScale;
    deepest_ = std::min(deepest_, needle_);
    least_energy_ = std::min(least_energy_, energy_);
    least_margin_ = std::min({least_margin_, leader_.margin(), follower_.margin()});
  }

  /// Down to -depth (m), and two seconds of rest.
  void press(double depth) {
    const double start = hand_;
    const int steps = static_cast<int>((start + depth) / kSpeed / kStep);
    for (int i = 1; i <= steps; ++i) step(start + (-depth - start) * i / steps);
    for (int i = 0; i < 2000; ++i) step(-depth);
  }

  /// N, at the hand's scale, on the needle.
  double touched() const { return stiffness_ * std::max(0.0, surface_ - needle_); }

  void expectPassive() const {
    const double reserve = config_.wave.receiver.reserve;
    EXPECT_GT(energy_, 0);
    EXPECT_GE(least_energy_, -2 * reserve);
    EXPECT_GE(least_margin_, -reserve);
  }

  double surface_ = -1;   // m, of what is touched
  double stiffness_ = 0;  // N/m
  LinkConfig config_;
  LinkLeader leader_{config_, kScale, kGain, 77};
  LinkFollower follower_{config_};
  LinkEmulator<LinkPacket> to_rig_{network(0)}, to_hand_{network(1000)};
  double now_ = 0, hand_ = 0, needle_ = 0, force_ = 0;  // s, m, m at the hand's scale, N
  double energy_ = 0, least_energy_ = 0;                // J, taken from the hand
  double least_margin_ = 0, deepest_ = 0;               // J, m
};

TEST_P(LinkNetwork, AStrokeInFreeMotionEndsWhereTheHandIs) {
  press(10e-3);
  EXPECT_NEAR(kScale * needle_, kScale * -10e-3, 0.05e-6);
  EXPECT_GT(kScale * deepest_, kScale * -10e-3 - 0.05e-6) << "a wave that comes back carries the needle on";
  EXPECT_LT(std::abs(force_), 0.005);
  expectPassive();
}

TEST_P(LinkNetwork, AHeldForceIsTheNeedlesAndTheChannelYieldsAsASpring) {
  surface_ = -5e-3;
  stiffness_ = 60;
  press(20e-3);
  ASSERT_GT(touched(), 0.3);
  EXPECT_NEAR(force_ / touched(), 1, 0.03);
  // Waves are as old as packets that come late, which overtaking ones and not the latest decide, and the filters add
  // their time.
  const WaveConfig& wave = config_.wave;
  const double filters = wave.receiver.filter_time + wave.receiver.highpass_loss * leader_.roundTrip() * kStep;
  const auto behind = [&](double delay) {
    return touched() * (1 / wave.stiffness + (delay + filters) / wave.impedance);
  };
  EXPECT_GT(needle_ - hand_, behind(kMean));
  EXPECT_LT(needle_ - hand_, behind(kLatest));
  expectPassive();
}

INSTANTIATE_TEST_SUITE_P(Seeds, LinkNetwork, testing::Values(1, 2, 3, 4));

}  // namespace
}  // namespace microinjection
