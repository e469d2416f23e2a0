// The interpreter of commands among the rig's obstacles, and with devices that are not the simulated one.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/rig_file.h"
#include "hardware/manipulator/simulated_manipulator.h"

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s

/// Says what it was told, and is where and how the test wants it to be.
class NotedDevice : public ManipulatorDevice {
 public:
  explicit NotedDevice(bool does_follow) : follows(does_follow) {}
  ManipulatorAbilities abilities() const override {
    ManipulatorAbilities result;
    result.follows = follows;
    return result;
  }
  void limitSpeed(const Eigen::Vector3d& axes) override { limits = axes; }
  void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d&) override { followed.push_back(joints); }
  void moveTo(const Eigen::Vector3d& joints, double speed) override {
    goal = joints;
    goal_speed = speed;
    is_moving = true;
  }
  void stop() override { ++stops; }
  void clearFault() override { now = State::kReady; }
  void step(double) override {}
  State state() const override { return now; }
  std::string reason() const override { return now == State::kReady ? "" : "the cable is out"; }
  std::optional<Reading> reading() const override { return position; }
  bool moving() const override { return is_moving; }

  bool follows;
  bool is_moving = false;
  State now = State::kReady;
  std::optional<Reading> position = Reading();
  std::vector<Eigen::Vector3d> followed;             // m
  std::optional<Eigen::Vector3d> goal;               // m
  double goal_speed = 0;                             // m/s
  Eigen::Vector3d limits = Eigen::Vector3d::Zero();  // m/s
  int stops = 0;
};

template <typename Device>
class Rig {
 public:
  template <typename... Arguments>
  explicit Rig(double tilt, Arguments... arguments)
      : geometry(ManipulatorGeometry::fromUrdf(rigUrdf(), tilt)),
        device(arguments...),
        micromanipulator(geometry, CollisionGuard(rigUrdf(), geometry, kMargin), MicromanipulatorConfig(), device) {}

  Eigen::Isometry3d at(double x, double y, double z) const {  // um
    Eigen::Isometry3d pose = geometry.tip_at_zero;
    pose.translation() = 1e-6 * Eigen::Vector3d(x, y, z);
    return pose;
  }
  Eigen::Vector3d tip() const { return micromanipulator.tipPose()->translation(); }
  void run(double duration) {
    for (int i = 0; i < std::lround(duration / kStep); ++i) micromanipulator.step(time += kStep, kStep);
  }

  ManipulatorGeometry geometry;
  Device device;
  Micromanipulator micromanipulator;
  double time = 0;  // s
};

class SimulatedRig : public Rig<SimulatedManipulator> {
 public:
  explicit SimulatedRig(double tilt = 0)
      : Rig(tilt, ManipulatorGeometry::fromUrdf(rigUrdf(), tilt), SimulatedManipulatorConfig()) {}
};

TEST(MicromanipulatorRig, CannotBeSentThroughTheDish) {
  SimulatedRig rig;
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(200, 0, -50)), "");
  rig.run(1);
  EXPECT_NEAR(rig.tip().z(), -50e-6, 1e-12);
  for (const Eigen::Isometry3d& wrong : {rig.at(200, 0, -59), rig.at(200, 0, -130), rig.at(0, 0, -27)}) {
    EXPECT_NE(rig.micromanipulator.movePosition(wrong).find("needle_tip would"), std::string::npos);
    EXPECT_NE(rig.micromanipulator.servoPosition(wrong).find("needle_tip would"), std::string::npos);
  }
  // Free, but the way there leads through the holding pipette.
  EXPECT_NE(rig.micromanipulator.movePosition(rig.at(-200, 0, -50)).find("holding_pipette"), std::string::npos);
  EXPECT_NE(rig.micromanipulator.servoPosition(rig.at(-200, 0, -50)).find("holding_pipette"), std::string::npos);
  rig.run(0.5);
  EXPECT_LT((rig.tip() - Eigen::Vector3d(200e-6, 0, -50e-6)).norm(), 1e-12);
}

TEST(MicromanipulatorRig, AVelocityStopsBeforeTheDishAndSaysSo) {
  for (const double speed : {50e-6, 500e-6, 1.9e-3}) {
    SimulatedRig rig;
    ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(300, 0, 500)), "");
    rig.run(2);
    std::string refusal, ended;
    double lowest = 1;  // m
    const int steps = static_cast<int>(std::lround(0.6e-3 / speed / kStep)) + 100;
    for (int i = 0; i < steps; ++i) {
      refusal = rig.micromanipulator.servoVelocity({0, 0, -speed}, rig.time);
      rig.run(kStep);
      lowest = std::min(lowest, rig.geometry.tip(rig.device.trueJoints()).z());
      if (ended.empty()) ended = rig.micromanipulator.abortReason();
    }
    EXPECT_NE(ended.find("of dish"), std::string::npos) << ended;
    EXPECT_NE(refusal.find("dish"), std::string::npos) << refusal;
    EXPECT_GE(lowest, -60e-6 + kMargin - 2e-9);
    const double braking = speed * speed / (2 * 0.2);  // m
    EXPECT_LT(lowest, -60e-6 + kMargin + braking + 2 * speed * kStep) << speed;
    // The way back is open.
    EXPECT_EQ(rig.micromanipulator.servoVelocity({0, 0, speed}, rig.time), "");
  }
}

TEST(MicromanipulatorRig, KeepsThePipettesTilt) {
  SimulatedRig rig(0.7);
  const Eigen::Vector3d axis(std::sin(0.7), 0, std::cos(0.7));
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(10, 20, 30)), "");
  rig.run(1);
  EXPECT_TRUE(rig.micromanipulator.tipPose()->linear().col(2).isApprox(axis, 1e-12));
  EXPECT_LT((rig.tip() - 1e-6 * Eigen::Vector3d(10, 20, 30)).norm(), 1e-12);
  Eigen::Isometry3d upright = rig.at(0, 0, 30);
  upright.linear().setIdentity();
  EXPECT_NE(rig.micromanipulator.movePosition(upright).find("orientation differs"), std::string::npos);
}

TEST(MicromanipulatorRig, MeasuresTheMotorsWhileTheCellFeelsTheTip) {
  SimulatedManipulatorConfig real;
  real.backlash = 1e-6;
  const ManipulatorGeometry geometry = ManipulatorGeometry::fromUrdf(rigUrdf());
  Rig<SimulatedManipulator> rig(0, geometry, real);
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(0, 0, 20)), "");
  rig.run(1);
  EXPECT_NEAR(rig.tip().z(), 20e-6, 1e-10);
  EXPECT_NEAR(geometry.tip(rig.device.trueJoints()).z(), 20.5e-6, 1e-10);
}

TEST(MicromanipulatorRig, ADeviceThatDoesNotFollowMovesByItself) {
  Rig<NotedDevice> rig(0, false);
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(30, 0, 100)), "");  // 30 and 40 um: 50 um
  ASSERT_TRUE(rig.device.goal);
  EXPECT_LT((*rig.device.goal - 1e-6 * Eigen::Vector3d(30, 0, 40)).norm(), 1e-15);
  EXPECT_NEAR(rig.device.goal_speed, 2e-3 / 0.8, 1e-12);  // the z axis is at its limit
  rig.run(0.1);
  EXPECT_TRUE(rig.micromanipulator.moving());
  EXPECT_TRUE(rig.device.followed.empty()) << "both would fight";
  rig.device.is_moving = false;
  rig.run(kStep);
  EXPECT_FALSE(rig.micromanipulator.moving());
  // It is sent set-points by servo_cp all the same, and makes short moves of them.
  rig.device.position->joints << 30e-6, 0, 40e-6;
  ASSERT_EQ(rig.micromanipulator.servoPosition(rig.at(30, 0, 100.1)), "");
  rig.run(kStep);
  ASSERT_EQ(rig.device.followed.size(), 1u);
  EXPECT_NEAR(rig.device.followed[0].z(), 40.1e-6, 1e-12);
}

TEST(MicromanipulatorRig, ADeviceIsLimitedToTheAxesSpeeds) {
  EXPECT_EQ(Rig<NotedDevice>(0, true).device.limits, Eigen::Vector3d::Constant(2e-3));
}

/// The device stays where it is: of one that follows, the line has lost what it was told.
void checkASetPointWaits(bool follows) {
  Rig<NotedDevice> rig(0, follows);
  // Up, over the holding pipette and beyond it; the device stays where it began, below the mouth and beside it.
  rig.device.position->joints = 1e-6 * Eigen::Vector3d(60, 0, -100);
  const auto stream = [&](double x, double z, int steps) {
    for (int i = 0; i < steps; ++i) {
      rig.micromanipulator.servoPosition(rig.at(x, 0, z));
      rig.run(kStep);
    }
  };
  stream(60, -10, 300);
  EXPECT_NEAR(rig.device.followed.back().z(), -70e-6, 1e-9);
  stream(-200, -10, 500);
  const Eigen::Vector3d waits = rig.device.followed.back();
  const CollisionGuard guard(rigUrdf(), rig.geometry, kMargin);
  EXPECT_EQ(guard.blocksPath(rig.device.position->joints, waits), "");
  EXPECT_GT(waits.x(), -30e-6);
  rig.device.position->joints = waits;  // it has come
  stream(-200, -10, 500);
  EXPECT_NEAR(rig.device.followed.back().x(), -200e-6, 1e-9);
  EXPECT_EQ(rig.device.stops, 0);
}

TEST(MicromanipulatorRig, ASetPointWaitsForADeviceThatWouldCutThroughAnObstacle) {
  checkASetPointWaits(false);
  checkASetPointWaits(true);
}

TEST(MicromanipulatorRig, ADeviceThatAnObstacleCutsOffFromItsSetPointIsStopped) {
  const Eigen::Vector3d disconnected = 1e-6 * Eigen::Vector3d(-200, 0, -100);  // on the holding pipette's other side
  for (const bool follows : {false, true}) {
    for (const bool by_stream : {false, true}) {
      SCOPED_TRACE(std::string(follows ? "follows" : "goes by moves") + (by_stream ? ", stream" : ", move"));
      Rig<NotedDevice> rig(0, follows);
      rig.device.position->joints = 1e-6 * Eigen::Vector3d(60, 0, -100);
      const Eigen::Isometry3d goal = rig.at(200, 0, -40);
      ASSERT_EQ(by_stream ? rig.micromanipulator.servoPosition(goal) : rig.micromanipulator.movePosition(goal), "");
      rig.run(0.05);
      EXPECT_EQ(rig.device.stops, 0);
      rig.device.position->joints = disconnected;
      const std::size_t told = rig.device.followed.size();
      rig.run(0.05);
      EXPECT_EQ(rig.device.stops, 1);
      EXPECT_EQ(rig.device.followed.size(), told);
      EXPECT_FALSE(rig.micromanipulator.moving());
      EXPECT_NE(rig.micromanipulator.abortReason().find("holding_pipette"), std::string::npos);
      EXPECT_NE(rig.micromanipulator.servoPosition(goal).find("holding_pipette"), std::string::npos);
    }
  }
}

TEST(MicromanipulatorRig, ADeviceThatIsOnItsWayToAHeldSetPointIsWatched) {
  Rig<NotedDevice> rig(0, true);
  rig.device.position->joints = 1e-6 * Eigen::Vector3d(60, 0, -100);
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(200, 0, -40)), "");
  rig.device.is_moving = true;
  rig.run(1);
  ASSERT_FALSE(rig.micromanipulator.moving());  // the set-point has arrived, the device has not
  EXPECT_EQ(rig.device.stops, 0);
  rig.device.position->joints = 1e-6 * Eigen::Vector3d(-200, 0, -100);
  rig.run(0.01);
  EXPECT_EQ(rig.device.stops, 1);
}

TEST(MicromanipulatorRig, ADeviceOutsideOfItsTravelMayComeBack) {
  Rig<NotedDevice> rig(0, true);
  rig.device.position->joints << 12.501e-3, 0, 1e-3;
  EXPECT_NE(rig.micromanipulator.servoVelocity({1e-4, 0, 0}, rig.time), "");
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(12400, 0, 1060)), "");
  rig.run(1);
  ASSERT_FALSE(rig.device.followed.empty());
  EXPECT_NEAR(rig.device.followed.back().x(), 12.4e-3, 1e-12);
}

TEST(MicromanipulatorRig, AStaleStreamStopsADeviceThatIsStillUnderWay) {
  Rig<NotedDevice> rig(0, false);
  ASSERT_EQ(rig.micromanipulator.servoPosition(rig.at(0, 0, 60.1)), "");
  rig.run(0.05);
  rig.device.is_moving = true;
  rig.run(0.1);
  EXPECT_EQ(rig.device.stops, 1);
  EXPECT_EQ(rig.micromanipulator.abortReason(), "servo_cp is stale");
}

TEST(MicromanipulatorRig, ADeviceThatIsGoneIsCommandedNothing) {
  Rig<NotedDevice> rig(0, true);
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(0, 0, 3000)), "");
  rig.run(0.1);
  rig.device.now = ManipulatorDevice::State::kDisconnected;
  rig.device.position.reset();
  const std::size_t told = rig.device.followed.size();
  rig.run(0.1);
  EXPECT_EQ(rig.device.followed.size(), told);
  EXPECT_FALSE(rig.micromanipulator.moving());
  EXPECT_FALSE(rig.micromanipulator.tipPose());
  EXPECT_FALSE(rig.micromanipulator.tipVelocity());
  EXPECT_EQ(rig.micromanipulator.servoPosition(rig.at(0, 0, 60)), "the cable is out");
  // Back, and somewhere else: it rests, and the next set-point starts from there.
  rig.device.now = ManipulatorDevice::State::kReady;
  EXPECT_EQ(rig.micromanipulator.servoPosition(rig.at(0, 0, 60)), "the device does not know its position yet");
  rig.device.position = ManipulatorDevice::Reading();
  rig.device.position->joints << 0, 0, 1e-3;
  rig.run(0.1);
  EXPECT_EQ(rig.device.followed.size(), told);
  ASSERT_EQ(rig.micromanipulator.movePosition(rig.at(0, 0, 3000)), "");
  rig.run(kStep);
  EXPECT_NEAR(rig.device.followed.back().z(), 1e-3, 1e-6);
}

}  // namespace
}  // namespace microinjection
