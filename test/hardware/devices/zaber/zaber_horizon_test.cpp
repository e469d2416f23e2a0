// A velocity that is not renewed ends by itself, where the firmware has moves with speeds of their own.

#include "hardware/devices/driver_fixture.h"

#include "hardware/devices/zaber/with_firmware.h"

namespace microinjection {
namespace {

constexpr double kFollowedSpeed = 0.2e-3;  // m/s

class ZaberHorizonTest : public DriverTest<TestedZaber> {
 protected:
  void follow(double duration, const Eigen::Vector3d& velocity = {kFollowedSpeed, 0, 0}) {
    rig_->run(duration, [&] {
      goal_ += velocity * 1e-3;
      rig_->driver().follow(goal_, velocity);
    });
  }
  /// The device lives on, whether anybody hears it or not.
  void letDeviceLive() { rig_->device().send(rig_->time()); }

  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();  // m
};

TEST_F(ZaberHorizonTest, APulledCableEndsTheMotion) {
  start();
  follow(0.7);
  rig_->wire().disconnectCable();
  const Eigen::Vector3d from = rig_->place();
  rig_->run(2);
  letDeviceLive();
  EXPECT_FALSE(rig_->device().moves());
  const double way = (rig_->place() - from).norm();
  EXPECT_GT(way, 0);
  EXPECT_LT(way, kFollowedSpeed * TestedZaber::config().move_horizon);
}

TEST_F(ZaberHorizonTest, ADeviceThatHearsNothingStops) {
  start();
  follow(0.7);
  rig_->inject("silence:3");
  const Eigen::Vector3d from = rig_->place();
  follow(2.9);
  EXPECT_FALSE(rig_->device().moves());
  EXPECT_LT((rig_->place() - from).norm(), kFollowedSpeed * TestedZaber::config().move_horizon);
}

TEST_F(ZaberHorizonTest, OlderFirmwareFollowsByVelocitiesAndSaysThatTheyDoNotEnd) {
  for (const auto& [version, ends] : {std::pair("6.28", false), {"7.05", false}, {"7.24", false}, {"7.25", true}}) {
    SCOPED_TRACE(version);
    make(withFirmware(version));
    start();
    goal_ = rig_->place();
    EXPECT_EQ(rig_->driver().abilities().device.find("7.25") == std::string::npos, ends);
    follow(1);
    EXPECT_LT((rig_->place() - goal_).norm(), kFollowedSpeed * rig_->driver().abilities().latency);
    EXPECT_EQ(rig_->device().movesBegun() > 0, ends);
    rig_->wire().disconnectCable();
    rig_->run(1);
    letDeviceLive();
    EXPECT_EQ(rig_->device().moves(), !ends);
  }
}

TEST_F(ZaberHorizonTest, ADeviceThatIsChangedForAnotherIsAskedAgain) {
  start();
  rig_->wire().disconnectCable();
  dynamic_cast<ZaberEmulator&>(rig_->device()).setFirmware("6.28");
  rig_->run(0.1);
  rig_->wire().connectCable();
  ASSERT_TRUE(rig_->runUntilReady());
  goal_ = rig_->place();
  follow(1);
  EXPECT_EQ(rig_->device().movesBegun(), 0);
  EXPECT_EQ(rig_->driver().state(), State::kReady) << rig_->driver().reason();
}

/// As the rigs' contract has it (contract_test.cpp), for what is told and for the truth.
TEST_F(ZaberHorizonTest, IsNeverAheadNorFartherBehindThanItsAbilitiesSay) {
  for (const char* version : {"6.28", "7.25"}) {
    for (const double speed : {2e-6, 20e-6, 200e-6}) {
      SCOPED_TRACE(std::string(version) + ", m/s: " + std::to_string(speed));
      make(withFirmware(version));
      start();
      goal_ = rig_->place();
      const ManipulatorAbilities abilities = rig_->driver().abilities();
      const double resolution = abilities.resolution, allowed_ahead = 3 * resolution + speed * 0.02;
      const double allowed_behind =
          speed * (2 * abilities.command_interval + abilities.reading_interval + abilities.latency) + 3 * resolution;
      double ahead = 0, behind = 0;  // m
      for (int i = 0; i < 1500; ++i) {
        follow(1e-3, {speed, 0, 0});
        for (const double place : {rig_->read().x(), rig_->place().x()}) {
          ahead = std::max(ahead, place - goal_.x());
          behind = std::max(behind, goal_.x() - place);
        }
      }
      EXPECT_LE(ahead, allowed_ahead);
      EXPECT_LE(behind, allowed_behind);
      rig_->driver().follow(goal_, Eigen::Vector3d::Zero());
      ASSERT_TRUE(rig_->runUntilArrived());
      expectNear(rig_->place(), goal_, resolution);
    }
  }
}

TEST_F(ZaberHorizonTest, FollowsOneMicrostepASecondWithoutTakingItForAStall) {
  start();
  const Eigen::Vector3d slow(kStep, 0, 0);
  follow(30, slow);
  EXPECT_EQ(rig_->driver().state(), State::kReady) << rig_->driver().reason();
  expectNear(rig_->place(), goal_, 2 * kStep);
}

TEST_F(ZaberHorizonTest, FollowsToTheEndOfItsTravel) {
  ZaberEmulatorConfig device;
  device.start = device.travel - 50e-6;
  make(device);
  start();
  goal_ = rig_->place();
  follow(0.2);  // 40 um, less than its way in the horizon
  rig_->driver().follow(goal_, Eigen::Vector3d::Zero());
  ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().reason();
  expectNear(rig_->place(), goal_, kStep);
}

TEST_F(ZaberHorizonTest, ThreeChainedDevicesTellTheirVersionsEach) {
  ZaberEmulatorConfig device;
  device.devices = {1, 2, 3};
  device.axes = {1, 1, 1};
  ZaberConfig driver = TestedZaber::config();
  for (int i = 0; i < 3; ++i) driver.addresses[i] = {i + 1, 1};
  make(device, driver);
  start();
  follow(0.5);
  EXPECT_GT(rig_->device().movesBegun(), 0);
}

/// A line that remembers what was written.
struct RecordingWire : EmulatedWire {
  using EmulatedWire::EmulatedWire;
  void write(const std::string& bytes, double time) override {
    written += bytes;
    EmulatedWire::write(bytes, time);
  }
  std::string written;
};

TEST(ZaberSettings, AreNotWrittenWhereAMoveHasASpeedOfItsOwn) {
  for (const auto& [version, writes] : {std::pair("6.28", true), {"7.25", false}}) {
    auto owned = std::make_unique<RecordingWire>(std::make_shared<ZaberEmulator>(withFirmware(version)), 115200);
    const RecordingWire& wire = *owned;
    ZaberDriver driver(TestedZaber::config(), std::move(owned));
    for (int i = 1; i < 1000; ++i) {
      if (i > 500) driver.moveTo(kPlace, 0.2e-3);
      driver.step(i * 1e-3);
    }
    EXPECT_NE(wire.written.find("move abs"), std::string::npos) << version;
    EXPECT_EQ(wire.written.find("set ") != std::string::npos, writes) << version;
  }
}

TEST(ZaberConfig, RefusesAHorizonThatEndsBetweenTwoTurns) {
  const auto read = [](const std::string& key, const YAML::Node& value) {
    YAML::Node node = loadYamlMap(MICROINJECTION_SOURCE_DIR "/config/rigs/zaber.yaml");
    (key == "baud" ? node["port"][key] : node[key]) = value;
    ConfigReader reader(node, "zaber.yaml");
    const ZaberConfig config = ZaberConfig::read(reader);
    reader.finish();
    return config;
  };
  EXPECT_EQ(read("move_horizon", YAML::Node(0.3)).move_horizon, 0.3);
  for (const auto& [key, value] : {std::pair("move_horizon", 0.09), {"baud", 9600.0}}) {
    try {
      read(key, YAML::Node(value));
      ADD_FAILURE() << key;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("move_horizon"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace microinjection
