#include "hardware/manipulator/simulated_manipulator.h"

#include <cmath>
#include <vector>

#include "base/errors.h"
#include "hardware/manipulator/plain_rig.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kRest = Eigen::Vector3d::Zero();

SimulatedManipulatorConfig ideal() {
  SimulatedManipulatorConfig config;
  config.servo_time_constant = 0;
  config.resolution = 0;
  return config;
}

/// A device that is sent somewhere, and asked after one step.
class Device {
 public:
  explicit Device(const SimulatedManipulatorConfig& config) : device(geometry(), config) { device.step(0); }

  /// True tip (m) on the x axis once it was sent to x (m).
  double at(double x) {
    device.follow({x, 0, 0}, kRest);
    run(1);
    return device.trueJoints().x();
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) device.step(time += kStep);
  }

  SimulatedManipulator device;
  double time = 0;  // s
};

TEST(SimulatedManipulator, AnIdealOneIsWhereItIsSent) {
  Device rig(ideal());
  EXPECT_EQ(rig.at(3e-4), 3e-4);
  EXPECT_EQ(rig.device.reading()->joints, Eigen::Vector3d(3e-4, 0, 0));
  EXPECT_DOUBLE_EQ(rig.device.reading()->velocity.x(), 3e-4 / kStep);
  EXPECT_FALSE(rig.device.moving());
}

TEST(SimulatedManipulator, LagIsOfFirstOrder) {
  SimulatedManipulatorConfig config = ideal();
  config.servo_time_constant = 5e-3;
  Device rig(config);
  rig.device.follow({1e-4, 0, 0}, kRest);
  for (int i = 1; i <= 20; ++i) {
    rig.run(1);
    EXPECT_NEAR(rig.device.reading()->joints.x(), 1e-4 * (1 - std::exp(-i * kStep / 5e-3)), 1e-16);
    EXPECT_TRUE(rig.device.moving());
  }
}

TEST(SimulatedManipulator, SetpointsAreRoundedToItsResolution) {
  SimulatedManipulatorConfig config = ideal();
  config.resolution = 40e-9;
  Device rig(config);
  EXPECT_NEAR(rig.at(95e-9), 80e-9, 1e-20);
  EXPECT_NEAR(rig.at(105e-9), 120e-9, 1e-20);
  EXPECT_NEAR(rig.at(-59e-9), -40e-9, 1e-20);
}

TEST(SimulatedManipulator, BacklashIsLostAtEachReversalOnly) {
  SimulatedManipulatorConfig config = ideal();
  config.backlash = 1e-6;
  Device rig(config);
  EXPECT_EQ(rig.at(0.4e-6), 0);  // in the middle of the dead zone at first
  EXPECT_NEAR(rig.at(10e-6), 9.5e-6, 1e-18);
  EXPECT_NEAR(rig.at(12e-6), 11.5e-6, 1e-18);
  EXPECT_NEAR(rig.at(11.2e-6), 11.5e-6, 1e-18);  // turned round: nothing moves for 1 um
  EXPECT_NEAR(rig.at(10.5e-6), 11e-6, 1e-18);
  EXPECT_NEAR(rig.at(5e-6), 5.5e-6, 1e-18);
  EXPECT_EQ(rig.device.reading()->joints.x(), 5e-6) << "its encoder sits at the motor";
}

TEST(SimulatedManipulator, HysteresisFollowsPrandtlAndIshlinskii) {
  SimulatedManipulatorConfig config = ideal();
  config.hysteresis.width = 0.4e-6;
  config.hysteresis.range = 4e-6;
  const int n = Hysteresis::kStops;
  const double weight = 0.4e-6 / (4e-6 * (n + 1));
  // How far the output lags once the input moved by `moved` with stops that start where they may give `room` times
  // their threshold: 1 from rest, 2 after a reversal from saturation.
  const auto held = [&](double moved, double room) {
    double sum = 0;
    for (int i = 1; i <= n; ++i) sum += weight * std::min(moved, room * 4e-6 * i / n);
    return sum;
  };
  Device rig(config);
  for (double x = 0.25e-6; x < 8e-6; x += 0.25e-6) EXPECT_NEAR(rig.at(x), x - held(x, 1), 1e-18);
  EXPECT_NEAR(rig.at(10e-6), 10e-6 - 0.2e-6, 1e-18);  // saturated: half of the width
  for (double x = 9.5e-6; x > -2e-6; x -= 0.5e-6) EXPECT_NEAR(rig.at(x), x - 0.2e-6 + held(10e-6 - x, 2), 1e-18) << x;
  EXPECT_NEAR(rig.at(-2e-6), -2e-6 + 0.2e-6, 1e-18);
  // A small loop closes: the memory of its turning points is wiped out.
  const double before = rig.at(-3e-6);
  rig.at(-2e-6);
  EXPECT_NEAR(rig.at(-3e-6), before, 1e-18);
}

TEST(SimulatedManipulator, DriftsLinearlyAndAtRandom) {
  SimulatedManipulatorConfig config = ideal();
  config.drift_rate << 2e-9, 0, -1e-9;
  Device linear(config);
  linear.run(5000);
  EXPECT_TRUE(linear.device.trueJoints().isApprox(Eigen::Vector3d(10e-9, 0, -5e-9), 1e-9));
  EXPECT_EQ(linear.device.reading()->joints, kRest) << "no encoder sees it";

  config.drift_rate.setZero();
  config.drift_walk = 1e-8;
  double squares = 0;
  const int walks = 400;
  for (int seed = 0; seed < walks; ++seed) {
    config.seed = seed;
    Device rig(config);
    rig.run(100);
    squares += rig.device.trueJoints().squaredNorm() / 3;
  }
  // 1200 independent samples: the estimate of a standard deviation scatters by 2 %.
  EXPECT_NEAR(std::sqrt(squares / walks), 1e-8 * std::sqrt(0.1), 0.07 * 1e-8 * std::sqrt(0.1));
  Device one(config), same(config);
  one.run(10);
  same.run(10);
  EXPECT_EQ(one.device.trueJoints(), same.device.trueJoints());
}

TEST(SimulatedManipulator, MovesByItselfWithinTheAxesLimits) {
  Device rig(ideal());
  const Eigen::Vector3d goal(3e-4, 0, -4e-4);
  rig.device.moveTo(goal, 1e-3);
  Eigen::Vector3d before = kRest, fastest = kRest, steepest = kRest;
  for (int i = 0; i < 2000 && rig.device.moving(); ++i) {
    rig.run(1);
    const Eigen::Vector3d velocity = rig.device.reading()->velocity;
    fastest = fastest.cwiseMax(velocity.cwiseAbs());
    steepest = steepest.cwiseMax((velocity - before).cwiseAbs() / kStep);
    before = velocity;
    const Eigen::Vector3d at = rig.device.reading()->joints;
    EXPECT_LT(at.cross(goal.normalized()).norm(), 1e-12) << "not straight";
  }
  EXPECT_EQ(rig.device.reading()->joints, goal);
  EXPECT_NEAR(fastest.norm(), 1e-3, 1e-6);
  EXPECT_LT(steepest.maxCoeff(), 0.05 * 1.0001);
}

TEST(SimulatedManipulator, StopsWithinItsStatedTime) {
  SimulatedManipulatorConfig config;
  Device rig(config);
  rig.device.moveTo({9e-4, 0, 0}, 2e-3);
  rig.run(200);
  EXPECT_NEAR(rig.device.reading()->velocity.x(), 2e-3, 1e-9);
  rig.device.stop();
  rig.run(static_cast<int>(std::ceil(rig.device.abilities().stop_time / kStep)));
  EXPECT_LT(rig.device.reading()->velocity.norm(), 0.01 * 2e-3);
  rig.run(100);
  EXPECT_LT(rig.device.reading()->velocity.norm(), 1e-12);
  EXPECT_FALSE(rig.device.moving());
}

TEST(SimulatedManipulator, AFaultStopsItUntilItIsCleared) {
  Device rig(ideal());
  rig.at(1e-4);
  rig.device.injectFault("motor is hot");
  EXPECT_EQ(rig.device.state(), ManipulatorDevice::State::kFault);
  EXPECT_EQ(rig.device.reason(), "motor is hot");
  EXPECT_EQ(rig.at(2e-4), 1e-4);
  rig.device.moveTo({2e-4, 0, 0}, 1e-3);
  rig.run(100);
  EXPECT_EQ(rig.device.trueJoints().x(), 1e-4);
  rig.device.clearFault();
  EXPECT_EQ(rig.device.state(), ManipulatorDevice::State::kReady);
  EXPECT_EQ(rig.device.reason(), "");
  rig.run(100);
  EXPECT_EQ(rig.device.trueJoints().x(), 1e-4) << "rests until the next command";
  EXPECT_EQ(rig.at(2e-4), 2e-4);
}

TEST(SimulatedManipulator, RefusesWhatNoDeviceIs) {
  const auto read = [](const std::string& text) {
    ConfigReader reader(YAML::Load(text), "test");
    const auto config = SimulatedManipulatorConfig::read(reader);
    reader.finish();
    return config;
  };
  EXPECT_DOUBLE_EQ(read("{backlash: 1.0e-6}").backlash, 1e-6);
  for (const char* wrong : {"{backlash: -1.0e-6}", "{resolution: -1}", "{hysteresis: {width: 2.0e-6, range: 1.0e-6}}",
                            "{drift_rate: [0, 0]}", "{drift_walk: .nan}", "{seed: -1}", "{lag: 1}"}) {
    EXPECT_THROW(read(wrong), ConfigError) << wrong;
  }
}

}  // namespace
}  // namespace microinjection
