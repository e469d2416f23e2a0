// Whatever is commanded, the set-point keeps the rig's limits and the needle stays clear of what stands there.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/rig_file.h"
#include "hardware/manipulator/simulated_manipulator.h"

namespace microinjection {
namespace {

class RandomCommands : public testing::TestWithParam<double> {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  /// Somewhere near the cell, or anywhere and a little beyond the travel; sometimes nowhere.
  Eigen::Isometry3d anyPose() {
    Eigen::Isometry3d pose = rig_.tip_at_zero;
    if (chance(0.2)) {
      pose.translation() << uniform(-20e-6, 20e-6), uniform(-20e-6, 20e-6), uniform(-27e-6, -25e-6);  // at the mouth
    } else if (chance(0.5)) {
      pose.translation() << uniform(-100e-6, 100e-6), uniform(-100e-6, 100e-6), uniform(-90e-6, 80e-6);
    } else {
      pose.translation() << uniform(-14e-3, 14e-3), uniform(-14e-3, 14e-3), uniform(-200e-6, 14e-3);
    }
    if (chance(0.02)) pose.translation().y() = std::numeric_limits<double>::quiet_NaN();
    if (chance(0.02)) pose.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
    return pose;
  }

  Eigen::Vector3d anyVelocity() {
    const double largest = chance(0.5) ? 2.5e-3 : 200e-6;
    return {uniform(-largest, largest), uniform(-largest, largest), uniform(-largest, largest)};
  }

  /// A pose a little further than the last one, as a stream has it.
  Eigen::Isometry3d nextOfStream() {
    if (chance(0.02)) stream_velocity_ = anyVelocity();
    if (!stream_ || chance(0.005)) stream_ = manipulator_.joints();
    *stream_ += stream_velocity_ * 1e-3;
    return rig_.tipPose(*stream_);
  }

  void command() {
    const double kind = uniform(0, 1);
    std::string refusal;
    if (kind < 0.5) {
      refusal = manipulator_.servoPosition(nextOfStream());
      if (!refusal.empty()) stream_velocity_ = anyVelocity();
    } else if (kind < 0.6) {
      refusal = manipulator_.servoPosition(anyPose());
    } else if (kind < 0.75) {
      refusal = manipulator_.servoVelocity(anyVelocity(), time_);
    } else if (kind < 0.95) {
      refusal = manipulator_.movePosition(anyPose());
    } else if (kind < 0.97) {
      manipulator_.stop();
      if (chance(0.9)) manipulator_.clearFault();  // lets the stream go on at once
    } else if (kind < 0.98) {
      device_.injectFault("test");
    } else {
      for (int i = 0; i < 2; ++i) manipulator_.clearFault();  // the fault; then the stream may go on
    }
    if (!refusal.empty()) ++refused_;
  }

  void step() {
    const double dt = chance(0.05) ? uniform(1e-4, 1e-2) : 1e-3;
    time_ += dt;
    const std::optional<AxesMotion> before = manipulator_.setpoint();
    manipulator_.step(time_, dt);
    const std::optional<AxesMotion> after = manipulator_.setpoint();
    if (before && after) checkStep(*before, *after, dt);
    checkPlace(device_.trueJoints());
  }

  void checkStep(const AxesMotion& before, const AxesMotion& after, double dt) {
    const Eigen::Vector3d velocity = (after.position - before.position) / dt;
    for (int i = 0; i < 3; ++i) {
      const auto& axis = rig_.axes[i];
      ASSERT_LE(std::abs(velocity[i]), axis.velocity * (1 + 1e-6));
      ASSERT_NEAR(velocity[i], after.velocity[i], axis.acceleration * dt * (1 + 1e-6));
      ASSERT_NEAR(velocity[i], before.velocity[i], axis.acceleration * dt * (1 + 1e-6));
      ASSERT_LE(std::abs(after.velocity[i] - before.velocity[i]), axis.acceleration * dt * (1 + 1e-6));
    }
    fastest_ = std::max(fastest_, velocity.cwiseAbs().maxCoeff());
    ASSERT_EQ(rig_.outsideTravel(after.position), "");
    const double clearance = guard_.clearance(after.position);
    nearest_ = std::min(nearest_, clearance);
    ASSERT_GE(clearance, kMargin - 2e-9);
  }

  void checkPlace(const Eigen::Vector3d& joints) {
    ASSERT_EQ(rig_.outsideTravel(joints), "");
    ASSERT_GE(guard_.clearance(joints), kMargin - kCorner);
  }

  /// m: a lag cuts a bend of the set-point's path by acceleration x time constant^2 at the most, on each of three axes.
  static constexpr double kCorner = 1.4e-6;

  ManipulatorGeometry rig_ = ManipulatorGeometry::fromUrdf(rigUrdf(), GetParam());
  CollisionGuard guard_{rigUrdf(), rig_, kMargin};
  SimulatedManipulator device_{rig_, SimulatedManipulatorConfig()};
  Micromanipulator manipulator_{rig_, guard_, MicromanipulatorConfig(), device_};
  std::mt19937_64 random_{11};
  std::optional<Eigen::Vector3d> stream_;  // m, joints
  Eigen::Vector3d stream_velocity_ = Eigen::Vector3d::Zero();
  double time_ = 0;     // s
  double fastest_ = 0;  // m/s
  double nearest_ = 1;  // m
  int refused_ = 0;
};

TEST_P(RandomCommands, NeverLeaveTheLimits) {
  const int commands = 50000;
  for (int i = 0; i < commands && !HasFatalFailure(); ++i) {
    command();
    const int steps = chance(0.003) ? 300 : 1;
    for (int j = 0; j < steps && !HasFatalFailure(); ++j) step();
  }
  // It was no idle run: limits were reached, commands refused and obeyed.
  EXPECT_GT(fastest_, 1.9e-3);
  EXPECT_LT(nearest_, kMargin + 0.5e-6);
  EXPECT_GT(refused_, commands / 20);
  EXPECT_LT(refused_, commands / 2);
  std::printf("tilt %.1f rad: refused %d of %d, nearest %.3g um\n", GetParam(), refused_, commands, nearest_ * 1e6);
}

INSTANTIATE_TEST_SUITE_P(UprightAndTilted, RandomCommands, testing::Values(0.0, 0.9));

}  // namespace
}  // namespace microinjection
