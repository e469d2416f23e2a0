// Axes that look for their reference positions, below the rig's own map of obstacles.

#include "hardware/devices/driver_fixture.h"
#include "hardware/manipulator/collision_guard.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/rig_file.h"

namespace microinjection {
namespace {

class ZaberHoming : public DriverTest<TestedZaber> {
 protected:
  void makeUnreferenced(const ZaberConfig& config) {
    ZaberEmulatorConfig device;
    device.referenced = false;
    make(device, config);
  }
  static ZaberConfig config() {
    ZaberConfig config = TestedZaber::config();
    config.home = true;
    return config;
  }
  Eigen::Vector3d joints() const { return config_.joints.toJoints(rig_->device().position()); }

  ZaberConfig config_ = config();
  ManipulatorGeometry geometry_ = ManipulatorGeometry::fromUrdf(rigUrdf());
  CollisionGuard guard_{rigUrdf(), geometry_, 2e-6};
};

TEST_F(ZaberHoming, EndsWhereTheRigsMapAllowsAndKeepsClearOnItsWay) {
  makeUnreferenced(config_);
  const Micromanipulator rig(geometry_, guard_, MicromanipulatorConfig(), rig_->driver());
  Eigen::Vector3d last = joints();
  ASSERT_EQ(guard_.blocks(last), "");
  const auto keepsClear = [&] {
    ASSERT_EQ(guard_.blocksPath(last, joints()), "") << joints().transpose();
    last = joints();
  };
  rig_->run(45, keepsClear);
  EXPECT_EQ(rig_->driver().state(), ManipulatorDevice::State::kReady) << rig_->driver().reason();
  expectNear(joints(), *rig_->driver().homingEnds(), kStep);
  EXPECT_EQ(guard_.blocks(joints()), "");
}

TEST_F(ZaberHoming, IsRefusedWhereItWouldEndInTheDish) {
  config_.joints.directions.setOnes();
  config_.joints.origin.setConstant(-12.5e-3);  // as config/rigs/zaber.yaml: z homes downwards
  makeUnreferenced(config_);
  const Micromanipulator rig(geometry_, guard_, MicromanipulatorConfig(), rig_->driver());
  const Eigen::Vector3d begin = joints();
  rig_->run(30);
  EXPECT_EQ(joints(), begin);
  EXPECT_EQ(rig_->driver().state(), ManipulatorDevice::State::kFault);
  EXPECT_NE(rig_->driver().reason().find("manipulator_z = -0.0125 m, allowed"), std::string::npos)
      << rig_->driver().reason();
  rig_->driver().clearFault();
  rig_->run(5);
  EXPECT_EQ(joints(), begin);
}

TEST_F(ZaberHoming, IsDoneInThePlansOrder) {
  makeUnreferenced(config_);
  const int order[] = {2, 0, 1};
  rig_->driver().planHoming({{order[0], order[1], order[2]}, ""});
  const Eigen::Vector3d begin = rig_->device().position();
  int homed = 0;
  rig_->run(45, [&] {
    const Eigen::Vector3d now = rig_->device().position();
    while (homed < 3 && now[order[homed]] == 0) ++homed;
    for (int i = homed + 1; i < 3; ++i) ASSERT_EQ(now[order[i]], begin[order[i]]) << "joint " << order[i];
  });
  EXPECT_EQ(homed, 3);
  EXPECT_EQ(rig_->driver().state(), ManipulatorDevice::State::kReady) << rig_->driver().reason();
}

TEST_F(ZaberHoming, IsNotTakenUpAgainAfterAStop) {
  makeUnreferenced(config_);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->device().moves(); }, 5));
  rig_->run(0.5);
  rig_->driver().stop();
  rig_->run(1);
  const Eigen::Vector3d stopped = rig_->device().position();
  EXPECT_FALSE(rig_->device().moves());
  rig_->run(20);
  EXPECT_EQ(rig_->device().position(), stopped);
  EXPECT_EQ(rig_->driver().state(), ManipulatorDevice::State::kFault);
  EXPECT_NE(rig_->driver().reason().find("no reference position"), std::string::npos) << rig_->driver().reason();
}

TEST_F(ZaberHoming, EndsReadyAlsoBehindAMoreImportantWarning) {
  makeUnreferenced(config_);
  rig_->inject("error:WV");
  EXPECT_TRUE(rig_->runUntilReady(60)) << rig_->driver().reason();
}

}  // namespace
}  // namespace microinjection
