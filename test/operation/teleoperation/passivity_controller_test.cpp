#include "operation/teleoperation/passivity_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "operation/teleoperation/haptic_loop.h"
#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {
namespace {

/// A hand on a wall whose force is `law(depth, step)`; returns the least energy and how the hand ends.
struct Outcome {
  double least = 0;      ///< J, exact
  double observed = 0;   ///< J, least
  double amplitude = 0;  ///< m, peak to peak over the last second
};

template <typename Law>
Outcome pressOn(const PassivityConfig& config, double hand_damping, Law law, double meant = -0.01) {
  VirtualHandConfig hand_config;
  hand_config.damping = hand_damping;
  VirtualHand hand(hand_config, Eigen::Vector3d(0, 0, 0.005));
  PassivityController controller(config);
  Outcome outcome;
  double energy = 0, low = 1, high = -1;
  for (int i = 0; i < 4000; ++i) {
    controller.observe(hand.position(), kStep);
    const Eigen::Vector3d wanted(0, 0, law(-hand.position().z(), i));
    const Eigen::Vector3d force = controller.control(wanted, wanted, kStep);
    controller.setRendered(force);
    const double before = hand.position().z();
    for (int k = 0; k < 10; ++k) hand.step(Eigen::Vector3d(0, 0, i < 3800 ? meant : 0.01), force, kStep / 10);
    energy -= force.z() * (hand.position().z() - before);
    outcome.least = std::min(outcome.least, energy);
    outcome.observed = std::min(outcome.observed, controller.energy());
    if (i < 2800 || i >= 3800) continue;
    low = std::min(low, hand.position().z());
    high = std::max(high, hand.position().z());
  }
  outcome.amplitude = high - low;
  return outcome;
}

double spring(double depth, int) { return 60 * std::max(0.0, depth); }

/// Pushes back a tenth of a second late, and harder on the way out than on the way in.
struct LateSpring {
  double operator()(double depth, int i) {
    late[i % 30] = depth;
    return 300 * std::max(0.0, late[(i + 1) % 30]);
  }
  double late[30] = {};
};

TEST(PassivityController, LeavesAPassiveWallAlone) {
  VirtualHand hand({}, Eigen::Vector3d(0, 0, 0.005));
  PassivityController controller({});
  for (int i = 0; i < 3000; ++i) {
    controller.observe(hand.position(), kStep);
    const Eigen::Vector3d wanted(0, 0, spring(-hand.position().z(), i));
    ASSERT_EQ(controller.control(wanted, wanted, kStep), wanted) << i;
    controller.setRendered(wanted);
    hand.step(Eigen::Vector3d(0, 0, 0.005 - 0.02 * std::sin(i * 1e-3 * 3)), wanted, kStep);
  }
}

TEST(PassivityController, CountsExactlyWhatTheHeldForceDid) {
  PassivityController controller({});
  controller.observe({0, 0, 0}, kStep);
  controller.setRendered({0, 0, 2});
  controller.observe({0.5, 0, -0.01}, kStep);
  EXPECT_DOUBLE_EQ(controller.energy(), 0.02);
  controller.setRendered({1, 0, 0});
  controller.observe({0.6, 0, -0.01}, kStep);
  EXPECT_NEAR(controller.energy(), 0.02 - 0.1, 1e-15);
}

TEST(PassivityController, MakesAnActiveThingPassive) {
  for (const double damping : {0.5, 6.0, 50.0}) {
    PassivityConfig config;
    config.enabled = false;
    const Outcome off = pressOn(config, damping, LateSpring());
    config.enabled = true;
    const Outcome on = pressOn(config, damping, LateSpring());
    EXPECT_LT(off.least, -2 * config.reserve) << damping;
    EXPECT_LT(off.observed, -2 * config.reserve) << damping;
    EXPECT_GT(on.least, -config.reserve) << damping;
    EXPECT_GT(on.observed, -config.reserve) << damping;
    EXPECT_LT(on.amplitude, 0.3e-3) << damping;
  }
}

TEST(PassivityController, AForceFromNothingGetsNoMoreThanTheReserve) {
  // Pushes outwards wherever the hand is, from 1 s on: an error of sign, a model gone wrong.
  PassivityConfig config;
  const auto push = [](double, int i) { return i > 1000 ? 1.0 : 0.0; };
  const Outcome on = pressOn(config, 6, push);
  EXPECT_GT(on.least, -config.reserve);
  config.enabled = false;
  EXPECT_LT(pressOn(config, 6, push).least, -2 * config.reserve);
}

TEST(PassivityController, AHoldKeepsTheEnergyOfWhatIsPressed) {
  PassivityController controller({});
  const auto at = [&](double z) {
    controller.observe({0, 0, z}, kStep);
    const Eigen::Vector3d wanted(0, 0, 60 * std::max(0.0, -z));
    const Eigen::Vector3d force = controller.control(wanted, wanted, kStep);
    controller.setRendered(force);
    return force == wanted;
  };
  for (int i = 0; i <= 400; ++i) ASSERT_TRUE(at(-0.02 * i / 400));
  // Clutched: the hand goes home without the needle, and comes back to press on from there.
  controller.setRendered(Eigen::Vector3d::Zero());
  controller.pause();
  controller.observe({0, 0, 0.1}, kStep);
  for (int i = -1000; i <= 380; ++i) {  // rests for a second, then goes out
    const double z = -0.02 * (1 - std::max(0, i) / 400.0);
    controller.observe({0, 0, 0.1 + 0.02 + z}, kStep);
    const Eigen::Vector3d wanted(0, 0, -60 * z);
    ASSERT_EQ(controller.control(wanted, wanted, kStep), wanted) << "the spring must give back what it holds, " << i;
    controller.setRendered(wanted);
  }
}

TEST(PassivityController, LongDissipationIsNoReserve) {
  // Stirred against friction for long, then pushed: the second must not live on the first.
  PassivityConfig config;
  PassivityController controller(config);
  double z = 0;
  for (int i = 0; i < 5000; ++i) {
    const double v = 0.1 * std::cos(i * 1e-3 * 20);
    z += v * kStep;
    controller.observe({0, 0, z}, kStep);
    const Eigen::Vector3d friction(0, 0, v > 0 ? -0.5 : 0.5);
    controller.setRendered(controller.control(friction, friction, kStep));
  }
  EXPECT_GT(controller.energy(), 0.1);
  const double before = controller.energy();
  for (int i = 0; i < 200; ++i) {
    z += 0.05 * kStep;
    controller.observe({0, 0, z}, kStep);
    const Eigen::Vector3d push(0, 0, 1);
    controller.setRendered(controller.control(push, push, kStep));
  }
  EXPECT_GT(controller.energy(), before - 0.004) << "of 0.01 J that the push would have given";
}

}  // namespace
}  // namespace microinjection
