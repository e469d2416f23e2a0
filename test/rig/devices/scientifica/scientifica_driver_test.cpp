#include "rig/devices/driver_fixture.h"

namespace microinjection {
namespace {

using ScientificaTest = DriverTest<TestedScientifica>;

ScientificaConfig oldCard() {
  ScientificaConfig config = TestedScientifica::config();
  config.version = 2;
  config.port.baud = 9600;
  return config;
}
ScientificaEmulatorConfig oldDevice() {
  ScientificaEmulatorConfig device;
  device.version = "2.13";
  return device;
}

TEST_F(ScientificaTest, ACardOfVersion2CountsTenths) {
  make(oldDevice(), oldCard());
  start();
  rig_->driver().moveTo(kPlace, 0.5e-3);
  ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().reason();
  expectNear(rig_->place(), kPlace, 0.1e-6);
  EXPECT_DOUBLE_EQ(rig_->driver().abilities().resolution, 0.1e-6);
}

TEST_F(ScientificaTest, WhatIsSlowerThanTheCardGoesInSteps) {
  make(oldDevice(), oldCard());
  start();
  const double from = rig_->time(), way = (kPlace - rig_->place()).norm(), speed = 20e-6;
  const Eigen::Vector3d start = rig_->place();
  double ahead = 0;
  rig_->driver().moveTo(kPlace, speed);
  ASSERT_TRUE(rig_->runUntil(
      [&] {
        ahead = std::max(ahead, (rig_->place() - start).norm() - speed * (rig_->time() - from));
        return rig_->time() > from + 1 && !rig_->driver().moving();
      },
      20));
  expectNear(rig_->place(), kPlace, 0.1e-6);
  EXPECT_LT(ahead, speed * 0.05 + 0.2e-6);  // a step
  EXPECT_GT(rig_->time() - from, 0.95 * way / speed);
  EXPECT_LT(rig_->time() - from, 2.5 * way / speed);
}

TEST(ScientificaConfigTest, AnAccelerationTooSlowForAShortMoveIsRefused) {
  const auto read = [](double acceleration, double segment_time) {
    YAML::Node file = YAML::Load("{port: {path: none}, speed: 1.0e-3, directions: [1, 1, 1], origin: [0, 0, 0]}");
    file["acceleration"] = acceleration;
    file["segment_time"] = segment_time;
    ConfigReader reader(file, "scientifica.yaml");
    ScientificaConfig::read(reader);
    reader.finish();
  };
  EXPECT_NO_THROW(read(0.02, 0.05));
  EXPECT_NO_THROW(read(0.002, 0.5));
  try {
    read(0.01, 0.05);
    FAIL();
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("acceleration = 0.01"), std::string::npos) << what;
    EXPECT_NE(what.find("at least speed / segment_time = 0.02"), std::string::npos) << what;
  }
}

struct Refusal {
  ScientificaEmulatorConfig device;
  std::string why;
};

TEST_F(ScientificaTest, ACardWithOtherUnitsIsRefusedWithItsAnswerAndMovesNothing) {
  ScientificaEmulatorConfig maker, version, future, scale;
  maker.maker = "X1";
  version.version = "2.13";
  future.version = "4.01";
  scale.scale = 2540;
  for (const Refusal& each : {Refusal{maker, "answers \"X1\" to \"SCIENTIFICA\": no card of Scientifica's"},
                              {version, "answers \"2.13\" to \"VER\": the file has version 3"},
                              {future, "answers \"4.01\" to \"VER\": the file has version 3"},
                              {scale, "answers \"2540.00\" to \"USTEP X\": its positions have another unit"}}) {
    SCOPED_TRACE(each.why);
    make(each.device);
    rig_->run(6, [&] {
      rig_->driver().moveTo(kPlace, 1e-3);
      EXPECT_FALSE(rig_->driver().reading());
    });
    EXPECT_EQ(rig_->driver().state(), State::kFault);
    EXPECT_NE(rig_->driver().reason().find(each.why), std::string::npos) << rig_->driver().reason();
    EXPECT_EQ(rig_->device().movesBegun(), 0);
  }
}

}  // namespace
}  // namespace microinjection
