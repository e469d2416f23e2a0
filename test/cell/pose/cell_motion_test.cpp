#include "cell/pose/cell_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "cell/pose/lip_suction.h"
#include "cell/pose/motion_scene.h"

namespace microinjection {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

CellMotionConfig farFromTheDish() {
  CellMotionConfig config;
  config.dish_height = -1;
  return config;
}

CellMotion loose(const CellMotionConfig& config, const Vector3d& position, const CellMotionInput& input = {}) {
  CellMotion motion(config, {}, RoundedTip(3e-6, 3e-6));
  EXPECT_TRUE(motion.place(position, Quaterniond::Identity(), input));
  return motion;
}

/// Held, at rest, with the mouth at the origin.
CellMotion held(const CellMotionConfig& config, CellMotionInput& input, double pressure) {
  CellMotion motion(config, holdingMouth(), RoundedTip(3e-6, 3e-6));
  input.mouth = mouthAt(Vector3d::Zero());
  input.pressure = pressure;
  placeBefore(motion, input);
  stepsOf(motion, input, 20);
  return motion;
}

TEST(CellMotion, SinksAtStokesSpeed) {
  const CellMotionConfig config = farFromTheDish();
  CellMotion motion = loose(config, Vector3d::Zero());
  const double speed =
      2.0 / 9 * config.density_difference * config.gravity * config.radius * config.radius / config.viscosity;
  EXPECT_NEAR(-stepsOf(motion, {}, 100).velocity.z() / speed, 1, 1e-3);
  EXPECT_NEAR(-motion.state().position.z() / (0.1 * speed), 1, 1e-3);
  EXPECT_EQ(motion.state().mode, CellMode::kFree);
}

TEST(CellMotion, TurnsAndDriftsAtStokesSpeeds) {
  const CellMotionConfig config = farFromTheDish();
  CellMotion motion = loose(config, Vector3d::Zero());
  CellMotionInput input;
  input.torque = {1e-16, -2e-16, 3e-16};
  input.force = {1e-12, 2e-12, config.weight()};
  stepsOf(motion, input, 100);
  const double resistance = 8 * M_PI * config.viscosity * std::pow(config.radius, 3);
  EXPECT_LT((motion.state().angular_velocity * resistance / input.torque.norm() - input.torque.normalized()).norm(),
            1e-3);
  const Eigen::AngleAxisd turned(motion.state().orientation);
  EXPECT_NEAR(turned.angle(), 0.1 * input.torque.norm() / resistance, 1e-3 * turned.angle());
  EXPECT_NEAR(turned.axis().dot(input.torque.normalized()), 1, 1e-6);
  EXPECT_NEAR(motion.state().velocity.y(), 2e-12 / (6 * M_PI * config.viscosity * config.radius), 1e-9);
}

TEST(CellMotion, SinksMoreSlowlyNearTheDish) {
  const CellMotionConfig config;
  for (const double gap : {0.1, 0.5431, 2.7622}) {
    CellMotion motion = loose(config, {0, 0, config.radius * (1 + gap)});
    const double speed = -motion.step(1e-5, {}).velocity.z() * config.drag() / config.weight();
    EXPECT_NEAR(speed * wallSeries(gap).perpendicular, 1, 2e-3) << gap;  // itself tested against Brenner's table
  }
}

TEST(CellMotion, RollsWhileItIsDraggedAlongTheDish) {
  CellMotionConfig config;
  config.density_difference = 0;
  const double gap = 0.0453, force = 1e-11;
  CellMotion motion = loose(config, {0, 0, config.radius * (1 + gap)});
  CellMotionInput input;
  input.force = {force, 0, 0};
  const CellMotionState& state = motion.step(1e-5, input);
  // Goldman, Cox and Brenner's resistances, solved for no torque.
  const WallFactors wall = wallSeries(gap);
  const double alone = force / config.drag(), ratio = wall.coupling / (4.0 / 3 * wall.rolling);
  EXPECT_NEAR(state.velocity.x() / (alone / (wall.parallel - wall.coupling * ratio)), 1, 1e-4);
  EXPECT_NEAR(state.angular_velocity.y() * config.radius / (state.velocity.x() * ratio), 1, 1e-4);
  EXPECT_GT(state.angular_velocity.y(), 0);  // as a wheel
}

TEST(CellMotion, RestsOnTheDish) {
  const CellMotionConfig config;
  CellMotion motion = loose(config, {0, 0, 60e-6});
  stepsOf(motion, {}, 20000);
  const double stiffness = 4.0 / 3 * config.contactModulus() * std::sqrt(config.radius);
  const double indentation = std::pow(config.weight() / stiffness, 2.0 / 3);
  EXPECT_NEAR(motion.state().position.z(), config.radius - indentation, 0.01e-9);
  EXPECT_NEAR(motion.state().dish.push / config.weight(), 1, 1e-4);
  EXPECT_EQ(motion.state().mode, CellMode::kResting);
  EXPECT_NEAR(motion.state().dish_gap, -indentation, 0.01e-9);
}

TEST(CellMotion, ReachesTheDishInTheTimeOfTheLastFilm) {
  CellMotionConfig config;
  config.roughness = 0.5e-6;
  CellMotion motion = loose(config, {0, 0, config.radius + 4e-6});
  int steps = 0;
  for (; motion.state().dish.push == 0 && steps < 100000; ++steps) motion.step(1e-3, {});
  // Integral of the resistance over the gap, which stays that of the smallest gap.
  double time = 0;
  const double slice = 1e-9;
  for (double gap = slice / 2; gap < 4e-6; gap += slice) {
    time += slice * config.drag() * wallSeries(std::max(gap, config.roughness) / config.radius).perpendicular /
            config.weight();
  }
  EXPECT_NEAR(1e-3 * steps / time, 1, 0.01);
}

TEST(CellMotion, ConvergesWithTheStep) {
  // Sinks, slides and rolls, and a needle dents it and pushes it aside.
  const auto end = [](int count) {
    CellMotionConfig config;
    CellMotionInput input;
    const double duration = 0.256 / count;
    input.needle = toolAlong(Vector3d::UnitZ(), {5e-6, 0, 95e-6});
    CellMotion motion = loose(config, {0, 0, 50e-6}, input);
    for (int i = 1; i <= count; ++i) {
      input.needle->position.z() = 95e-6 - 30e-6 * std::pow(static_cast<double>(i) / count, 2);
      motion.step(duration, input);
    }
    return motion.state().position;
  };
  const Vector3d exact = end(16384);
  std::vector<double> errors;
  for (const int count : {64, 128, 256, 512}) errors.push_back((end(count) - exact).norm());
  EXPECT_LT(errors[0], 2e-6);
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_NEAR(errors[i - 1] / errors[i], 2, 0.35) << errors[i];
}

TEST(CellMotion, IsPickedUpCarriedAndDropped) {
  const CellMotionConfig config;
  CellMotion motion(config, holdingMouth(), {});
  CellMotionInput input;
  input.mouth = mouthAt({0, 0, 100e-6});
  input.pressure = -500;
  placeBefore(motion, input, 2e-6);
  EXPECT_GT(motion.state().leak, 0);
  EXPECT_EQ(motion.state().mode, CellMode::kFree);
  stepsOf(motion, input, 50);
  EXPECT_EQ(motion.state().mode, CellMode::kHeld);
  EXPECT_TRUE(motion.state().sealed);
  EXPECT_EQ(motion.state().leak, 0);
  const double seal = holdingMouth().touchRadius(config.radius);
  EXPECT_NEAR(motion.state().suction, 500 * M_PI * seal * seal, 1e-12);
  // Carried at 0.2 mm/s, up and across the tube.
  for (int i = 0; i < 500; ++i) {
    input.mouth.position += Vector3d(0, 0.2e-6, 0.2e-6);
    motion.step(1e-3, input);
  }
  EXPECT_EQ(motion.state().mode, CellMode::kHeld);
  EXPECT_LT((motion.state().velocity - Vector3d(0, 0.2e-3, 0.2e-3)).norm(), 1e-6);
  const Vector3d offset = motion.state().position - input.mouth.position;
  EXPECT_LT((offset - Vector3d(holdingMouth().touchDistance(config.radius), 0, 0)).norm(),
            0.6e-6);  // the lip's indentation
  input.pressure = 0;
  stepsOf(motion, input, 300);  // it tips over the lower lip
  EXPECT_EQ(motion.state().lip.push, 0);
  EXPECT_EQ(motion.state().mode, CellMode::kFree);
  stepsOf(motion, input, 60000);
  EXPECT_EQ(motion.state().mode, CellMode::kResting);
  EXPECT_NEAR(motion.state().position.z(), config.radius, 0.02e-6);
}

TEST(CellMotion, IsHeldUpToThePullOfTheSuction) {
  CellMotionInput input;
  CellMotion motion = held(farFromTheDish(), input, -500);
  const double pull = motion.limits(-500).suction();
  input.force = {0.995 * pull, 0, 0};
  EXPECT_EQ(stepsOf(motion, input, 1000).mode, CellMode::kHeld);
  input.force = {1.005 * pull, 0, 0};
  EXPECT_NE(stepsOf(motion, input, 1000).mode, CellMode::kHeld);
}

TEST(CellMotion, TheSealOpensAtHalfOfTheForceThatTipsARigidCell) {
  CellMotionConfig config = farFromTheDish();
  config.modulus = 1e7;  // the gap at which it tips must not leak
  config.density_difference = 0;
  config.friction.lip = 0;
  CellMotionInput input;
  CellMotion motion = held(config, input, -500);
  const HoldLimits limits = motion.limits(-500);
  double opens = 0, comes_off = 0;
  for (double share = 0.3; share < 1.2 && comes_off == 0; share += 0.005) {
    input.force = {0, share * limits.sideways(), 0};
    stepsOf(motion, input, 100);
    if (opens == 0 && !motion.state().sealed) opens = share;
    if (motion.state().mode != CellMode::kHeld) comes_off = share;
  }
  EXPECT_NEAR(opens, 0.5, 0.01);
  EXPECT_NEAR(comes_off, 1, 0.02);
}

TEST(CellMotion, AnOpenSealPullsAsMuchAsItsGapLets) {
  CellMotionConfig config = farFromTheDish();
  config.density_difference = 0;
  config.friction.lip = 0;
  CellMotionInput input;
  CellMotion motion = held(config, input, -500);
  const LipSuction suction(holdingMouth(), config);
  const double closed = 500 * suction.area();  // N, what a rigid sphere's seal holds
  input.force = {0, 0.72 * HoldLimits(closed, suction.sealRadius(), config.radius, 0).sideways(), 0};
  const CellMotionState& state = stepsOf(motion, input, 2000);
  ASSERT_EQ(state.mode, CellMode::kHeld);
  ASSERT_FALSE(state.sealed);
  EXPECT_GT(state.leak, 0);
  EXPECT_LT(state.suction, 0.998 * closed);
  // What the gap all round the lip lets act is what the step used, about the mean gap.
  const LipContact lip(holdingMouth(), config.radius, config.contactModulus());
  EXPECT_NEAR(state.suction, 500 * suction.area() * suction.share(lip.leakingGap(input.mouth.toOwn(state.position)), 0),
              1e-16);
  const Vector3d to_middle = (Vector3d(-suction.middle(), 0, 0) - state.position).normalized();
  EXPECT_LT((state.lip.force + state.suction * to_middle + input.force).norm(), 3e-4 * state.suction);
}

TEST(CellMotion, TurnsInItsSeatAtTheLimitOfFriction) {
  CellMotionConfig config = farFromTheDish();
  config.density_difference = 0;
  config.friction.lip = 0.05;  // with more, the sideways part of friction opens the seal first
  config.creep_speed = 1e-9;
  CellMotionInput input;
  CellMotion motion = held(config, input, -500);
  const HoldLimits limits = motion.limits(-500);
  for (const auto& [torque, limit] : {std::pair<Vector3d, double>{Vector3d::UnitZ(), limits.turning()},
                                      std::pair<Vector3d, double>{Vector3d::UnitX(), limits.spinning()}}) {
    input.torque = 0.98 * limit * torque;
    stepsOf(motion, input, 200);
    EXPECT_LT(motion.state().angular_velocity.norm() * config.radius, 5e-9);
    input.torque = 1.02 * limit * torque;
    stepsOf(motion, input, 20);
    EXPECT_GT(motion.state().angular_velocity.norm() * config.radius, 1e-6);
    EXPECT_EQ(motion.state().mode, CellMode::kSlipping);
    input.torque.setZero();
    stepsOf(motion, input, 20);
  }
}

TEST(CellMotion, ANeedleBesideTheAxisTurnsTheCellAtTheRigidSpheresLimit) {
  CellMotionConfig config = farFromTheDish();
  config.density_difference = 0;
  config.friction.lip = 0.05;
  config.friction.needle = 2;
  CellMotionInput input;
  CellMotion motion = held(config, input, -2000);
  const double beside = 20e-6;
  const Vector3d centre = motion.state().position;
  double from = std::sqrt(std::pow(config.radius + 3e-6, 2) - beside * beside) - 3e-6;
  input.needle = toolAlong(Vector3d::UnitX(), centre + Vector3d(from, beside, 0));
  int steps = 0;
  const double speed = 2e-6;
  // A part of the seat slips at once; the cell turns when the whole of it slides about as fast as the needle.
  while (!(motion.state().lip.slips && motion.state().lip.sliding > speed / 2) && steps++ < 20000) {
    input.needle->position.x() -= 1e-3 * speed;
    motion.step(1e-3, input);
  }
  ASSERT_LT(steps, 20000);
  const Vector3d force = motion.state().needle.force;
  EXPECT_GT(force.norm(), 1e-8);
  // Into the mouth's frame: its z points into the tube, along -x.
  const auto own = [&](const Vector3d& v) { return Vector3d(input.mouth.orientation.conjugate() * v); };
  const Vector3d out = (input.needle->position + 3e-6 * Vector3d::UnitX() - motion.state().position).normalized();
  // The point is relative to the centre where the cell now is, so that its shift in the seat does not count again.
  const HoldLimits rigid(motion.limits(-2000).suction(), LipSuction(holdingMouth(), config).sealRadius(), config.radius,
                         config.friction.lip);
  const double limit = rigid.largest(own(config.radius * out), own(force));
  EXPECT_NEAR(force.norm() / limit, 1, 0.02);
}

TEST(CellMotion, RollsBetweenANeedleAndTheDishWithoutSlip) {
  CellMotionConfig config;
  config.friction.needle = 0.3;
  const double travel = 6e-6, speed = 5e-6;
  for (const double turn : {0.0, 1.1, M_PI / 2}) {
    const Vector3d ahead(std::cos(turn), std::sin(turn), 0), lying = Vector3d::UnitZ().cross(ahead);
    CellMotionInput input;
    // From behind the top to beyond it, since the needle's shaft goes twice as far as the cell.
    const Vector3d top(0, 0, 2 * config.radius + 3e-6);
    input.needle = toolAlong(lying, top - travel / 4 * ahead - 500e-6 * lying);
    CellMotion motion = loose(config, {0, 0, config.radius}, input);
    input.needle->position.z() -= 0.5e-6;
    const CellMotionState before = stepsOf(motion, input, 50);
    const int count = static_cast<int>(std::lround(travel / speed / 1e-3));
    for (int i = 0; i < count; ++i) {
      input.needle->position += 1e-3 * speed * ahead;
      motion.step(1e-3, input);
    }
    EXPECT_FALSE(motion.state().dish.slips);
    EXPECT_FALSE(motion.state().needle.slips);
    // The cell goes half as far as the shaft, and turns about what lies across, forwards.
    EXPECT_NEAR((motion.state().position - before.position).dot(ahead) / (travel / 2), 1, 0.02);
    EXPECT_NEAR(motion.state().angular_velocity.dot(lying) / (speed / (2 * config.radius)), 1, 0.02);
    const Eigen::AngleAxisd turned(motion.state().orientation * before.orientation.inverse());
    EXPECT_NEAR(turned.angle() * turned.axis().dot(lying) / (travel / (2 * config.radius)), 1, 0.02);
  }
}

TEST(CellMotion, ASlipperyNeedlePushesItAlong) {
  CellMotionConfig config;
  config.friction.needle = 0;
  config.friction.dish = 0;
  CellMotionInput input;
  input.needle = toolAlong(-Vector3d::UnitX(), {-config.radius, 0, config.radius});
  CellMotion motion = loose(config, {0, 0, config.radius}, input);
  for (int i = 0; i < 1000; ++i) {
    input.needle->position.x() += 0.02e-6;
    motion.step(1e-3, input);
  }
  EXPECT_NEAR(motion.state().position.x(), 20e-6, 0.1e-6);
  // The force that the hand feels is the drag beside the dish, free to roll.
  const WallFactors wall = wallSeries(config.roughness / config.radius);
  const double drag =
      config.drag() * 20e-6 * (wall.parallel - wall.coupling * wall.coupling / (4.0 / 3 * wall.rolling));
  EXPECT_NEAR(motion.state().needle.force.x() / drag, 1, 0.01);
}

TEST(CellMotion, EnergyNeverRisesByItself) {
  // Between tools that stand still: all that falls goes into the medium and into friction.
  CellMotionConfig config;
  CellMotionInput input;
  input.needle = toolAlong(Vector3d::UnitZ(), {8e-6, 3e-6, 70e-6});
  CellMotion motion = loose(config, {0, 0, 36e-6}, input);  // squeezed by 4 um from below and more from above
  double last = motion.state().energy.potential;
  const double begin = last;
  for (int i = 0; i < 500; ++i) {
    const CellMotionState& state = motion.step(1e-3, input);
    EXPECT_EQ(state.energy.work, 0);
    EXPECT_LE(state.energy.potential, last + 1e-13 * begin) << i;
    EXPECT_GE(state.energy.viscous, 0);
    last = state.energy.potential;
  }
  EXPECT_LT(last, 0.5 * begin);
}

TEST(CellMotion, EnergyIsNoMoreThanTheToolsLend) {
  CellMotionConfig config;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  CellMotion motion(config, holdingMouth(), RoundedTip(3e-6, 3e-6));
  CellMotionInput input;
  input.mouth = mouthAt({0, 0, 60e-6});
  input.needle = toolAlong(Vector3d::UnitX(), {90e-6, 0, 60e-6});
  input.pressure = -500;
  placeBefore(motion, input);
  const double scale = 1e-15;  // J: a thousandth of what a nanonewton does over a micrometre
  double total = motion.state().energy.potential, dissipated = 0, touched = 0;
  for (int i = 0; i < 4000; ++i) {
    const double jump = i % 100 == 0 ? 20e-6 : 0.3e-6;
    const auto drawn = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
    input.mouth.position =
        mouthAt({0, 0, 60e-6}).position + 0.9 * (input.mouth.position - Vector3d(0, 0, 60e-6)) + 0.1 * jump * drawn();
    input.needle->position =
        Vector3d(72e-6, 0, 60e-6) + 0.95 * (input.needle->position - Vector3d(72e-6, 0, 60e-6)) + jump * drawn();
    if (i % 50 == 0) input.pressure = -500 + 300 * normal(random);
    const CellMotionState& state = motion.step(i % 7 == 0 ? 2e-2 : 1e-3, input);
    const CellMotionEnergy& energy = state.energy;
    ASSERT_TRUE(state.position.allFinite());
    EXPECT_LE(energy.rise, -energy.viscous / 2 - energy.friction + 1e-6 * scale) << i;
    EXPECT_GE(energy.viscous, 0);
    total += energy.work + energy.rise;
    EXPECT_NEAR(total, energy.potential, 1e-6 * scale + 1e-9 * std::abs(total)) << i;  // nothing else changes it
    dissipated += energy.viscous;
    touched += state.needle.push > 0;
  }
  EXPECT_GT(dissipated, scale);
  EXPECT_GT(touched, 500);
}

TEST(CellMotion, ReportsTheForcesThatBalance) {
  CellMotionInput input;
  CellMotionConfig config;
  CellMotion motion(config, holdingMouth(), RoundedTip(3e-6, 3e-6));
  input.mouth = mouthAt({0, 0, config.radius});
  input.pressure = -500;
  placeBefore(motion, input);
  const Vector3d centre = motion.state().position;
  input.needle = toolAlong(Vector3d::UnitX(), centre + Vector3d(config.radius, 10e-6, 5e-6));
  for (int i = 0; i < 500; ++i) {
    input.needle->position.x() -= 5e-9;
    motion.step(1e-3, input);
  }
  stepsOf(motion, input, 3000);
  const CellMotionState& state = motion.state();
  EXPECT_GT(state.needle.push, 1e-8);
  const Vector3d to_middle =
      (input.mouth.position - Vector3d(LipSuction(holdingMouth(), config).middle(), 0, 0) - state.position)
          .normalized();
  const Vector3d sum = state.lip.force + state.dish.force + state.needle.force + state.suction * to_middle -
                       Vector3d(0, 0, config.weight());
  EXPECT_LT(sum.norm(), 1e-3 * state.needle.push);
  EXPECT_LT((state.lip.torque + state.dish.torque + state.needle.torque).norm(),
            1e-3 * state.needle.push * config.radius);
}

TEST(CellMotion, ANotchLowersWhatItHolds) {
  CellMotionInput input;
  CellMotion motion = held(farFromTheDish(), input, -500);
  const double whole = motion.limits(-500).suction(), notched = motion.limits(-500, 30e-12).suction();
  EXPECT_LT(notched, 0.9 * whole);
  input.notch_area = 30e-12;
  stepsOf(motion, input, 50);
  EXPECT_TRUE(motion.state().sealed);
  EXPECT_NEAR(motion.state().suction, notched, 1e-3 * notched);
  EXPECT_GT(motion.state().leak, 0);
  input.force = {(notched + whole) / 2, 0, 0};
  EXPECT_NE(stepsOf(motion, input, 500).mode, CellMode::kHeld);
}

TEST(CellMotion, FarFromTheMouthTheSinkFlowCarriesIt) {
  CellMotionConfig config = farFromTheDish();
  config.density_difference = 0;
  CellMotion motion(config, holdingMouth(), {});
  CellMotionInput input;
  input.mouth = mouthAt(Vector3d::Zero());
  input.pressure = -2000;
  const double distance = 300e-6;
  motion.place({distance, 0, 0}, Quaterniond::Identity(), input);
  const double speed = -motion.step(1e-3, input).velocity.x();
  EXPECT_NEAR(speed / (motion.state().leak / (4 * M_PI * distance * distance)), 1, 0.01);
}

TEST(CellMotion, SaysThatAWideMouthHasSwallowedIt) {
  CellMotionConfig config = farFromTheDish();
  CellMotion motion(config, holdingMouth(50e-6), {});
  EXPECT_EQ(motion.limits(-100).suction(), 0);
  CellMotionInput input;
  input.mouth = mouthAt(Vector3d::Zero());
  input.pressure = -100;
  motion.place({60e-6, 0, 0}, Quaterniond::Identity(), input);
  EXPECT_NE(motion.state().mode, CellMode::kSwallowed);
  stepsOf(motion, input, 2000);
  ASSERT_EQ(motion.state().mode, CellMode::kSwallowed);
  EXPECT_STREQ(name(motion.state().mode), "swallowed");
  const Vector3d inside = motion.state().position;
  input.mouth.position.y() = 30e-6;
  motion.step(1e-3, input);
  EXPECT_NEAR((motion.state().position - inside - Vector3d(0, 30e-6, 0)).norm(), 0, 1e-12);
}

TEST(CellMotion, IsLostFarFromTheMouth) {
  CellMotionConfig config;
  CellMotion motion(config, holdingMouth(), {});
  CellMotionInput input;
  input.mouth = mouthAt({0, 0, config.radius});
  motion.place({2e-3, 0, config.radius}, Quaterniond::Identity(), input);
  EXPECT_EQ(motion.step(1e-3, input).mode, CellMode::kLost);
}

TEST(CellMotion, StaysStableWhileThePressureReverses) {
  CellMotionInput input;
  CellMotion motion = held(CellMotionConfig(), input, -500);
  input.mouth = mouthAt({0, 0, 100e-6});
  placeBefore(motion, input);
  double farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    input.pressure = -500 * std::cos(2 * M_PI * 20 * 1e-3 * i);
    const CellMotionState& state = motion.step(1e-3, input);
    ASSERT_TRUE(state.position.allFinite() && state.lip.force.allFinite());
    EXPECT_LE(state.energy.rise, 1e-20);
    farthest = std::max(farthest, (state.position - input.mouth.position).norm());
  }
  // The volume that flows out in half a period, and the cell's sinking, move it no further.
  EXPECT_LT(farthest, 500e-6);
  EXPECT_GT(farthest, holdingMouth().touchDistance(40e-6));
}

TEST(CellMotion, BearsNeedleJumps) {
  CellMotionInput input;
  CellMotion motion = held(farFromTheDish(), input, -500);
  input.needle = toolAlong(Vector3d::UnitX(), motion.state().position + Vector3d(45e-6, 2e-6, 0));
  motion.step(1e-3, input);
  for (int i = 0; i < 50; ++i) {
    input.needle->position.x() += i % 2 == 0 ? -50e-6 : 50e-6;
    const CellMotionState& state = motion.step(1e-3, input);
    ASSERT_TRUE(state.position.allFinite() && state.needle.force.allFinite() && state.lip.force.allFinite());
    EXPECT_LT(state.position.norm(), 1e-3);
    EXPECT_NEAR(state.orientation.norm(), 1, 1e-12);
    EXPECT_LE(state.energy.rise, 1e-20);
  }
}

TEST(CellMotion, RefusesWhatIsNotFinite) {
  CellMotionInput input;
  CellMotion motion = held(farFromTheDish(), input, -500);
  const Vector3d before = motion.state().position;
  std::vector<CellMotionInput> bad(7, input);
  bad[0].mouth.position.x() = NAN;
  bad[1].pressure = INFINITY;
  bad[2].notch_area = -1e-12;
  bad[3].needle = toolAlong(Vector3d::UnitX(), {NAN, 0, 0});
  bad[4].force.y() = NAN;
  bad[5].torque.z() = INFINITY;
  bad[6].mouth.orientation.coeffs() *= 3;
  for (const CellMotionInput& wrong : bad) {
    const CellMotionState& state = motion.step(1e-3, wrong);
    ASSERT_NE(state.refusal, nullptr);
    EXPECT_GT(std::strlen(state.refusal), 10u);
    EXPECT_EQ(state.position, before);
    EXPECT_EQ(state.mode, CellMode::kHeld);
  }
  EXPECT_NE(motion.step(0, input).refusal, nullptr);
  EXPECT_FALSE(motion.place({NAN, 0, 0}, Quaterniond::Identity(), input));
  EXPECT_EQ(motion.state().position, before);
  EXPECT_EQ(motion.step(1e-3, input).refusal, nullptr);
  EXPECT_LT((motion.state().position - before).norm(), 1e-9);
  CellMotion without(farFromTheDish(), {}, {});
  EXPECT_NE(without.step(1e-3, input).refusal, nullptr);  // a pressure without a mouth
}

TEST(CellMotion, GivesTheSameBytesAgain) {
  const auto run = [] {
    CellMotionInput input;
    CellMotion motion = held(CellMotionConfig(), input, -300);
    input.needle = toolAlong(Vector3d::UnitX(), motion.state().position + Vector3d(41e-6, 9e-6, 0));
    for (int i = 0; i < 300; ++i) {
      input.needle->position.x() -= 10e-9;
      motion.step(1e-3, input);
    }
    const CellMotion copy = motion;  // has no pointer into the other
    return copy.state().position;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace microinjection
