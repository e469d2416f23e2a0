// A device that follows late goes round obstacles without being refused what it can do.

#include <gtest/gtest.h>

#include "../manipulator/rig_file.h"
#include "hardware/devices/needle_loop.h"
#include "hardware/devices/zaber/zaber_driver.h"
#include "hardware/devices/zaber/zaber_emulator.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/serial/emulated_wire.h"

namespace microinjection {
namespace {

class Needle {
 public:
  Needle() {
    config_.joints.origin.setConstant(-12.5e-3);
    driver_ = std::make_unique<ZaberDriver>(config_, std::make_unique<EmulatedWire>(device_, config_.port.baud));
    needle_ = std::make_unique<Micromanipulator>(geometry_, guard_, MicromanipulatorConfig(), *driver_);
    run(1);
  }
  void run(double duration) {
    for (int i = 0; i < std::lround(duration / kStep); ++i) {
      needle_->step(time_ += kStep, kStep);
      nearest_ = std::min(nearest_, guard_.clearance(joints()));
      if (ended_.empty()) ended_ = needle_->abortReason();
    }
  }
  void moveTo(const Eigen::Vector3d& place) {
    ASSERT_EQ(needle_->movePosition(pose(place)), "");
    run(2);
    ASSERT_LT((tip() - place).norm(), 0.1e-6);
    stream_ = place;
  }
  /// In a straight line from the last place; a set-point that is refused is sent again.
  void streamTo(const Eigen::Vector3d& place, double speed) {
    const Eigen::Vector3d from = stream_;
    const int steps = static_cast<int>((place - from).norm() / speed / kStep);
    for (int i = 1; i <= steps; ++i) {
      stream_ = from + (place - from) * i / steps;
      if (!needle_->servoPosition(pose(stream_)).empty()) ++refused_;
      run(kStep);
    }
  }
  Eigen::Vector3d tip() const { return geometry_.tip(joints()); }
  double nearest() const { return nearest_; }
  int refused() const { return refused_; }
  const std::string& ended() const { return ended_; }

 private:
  Eigen::Isometry3d pose(const Eigen::Vector3d& place) const {
    Eigen::Isometry3d result = geometry_.tip_at_zero;
    result.translation() = place;
    return result;
  }
  Eigen::Vector3d joints() const { return config_.joints.toJoints(device_->position()); }

  ZaberConfig config_;
  ManipulatorGeometry geometry_ = ManipulatorGeometry::fromUrdf(rigUrdf(), 0);
  CollisionGuard guard_{rigUrdf(), geometry_, kMargin};
  std::shared_ptr<ZaberEmulator> device_ = std::make_shared<ZaberEmulator>();
  std::unique_ptr<ZaberDriver> driver_;
  std::unique_ptr<Micromanipulator> needle_;
  Eigen::Vector3d stream_ = Eigen::Vector3d::Zero();  // m
  double time_ = 0;                                   // s
  double nearest_ = 1;                                // m
  int refused_ = 0;
  std::string ended_;
};

const Eigen::Vector3d kBefore(60e-6, 0, -50e-6), kCorner(60e-6, 0, -10e-6), kBehind(-200e-6, 0, -10e-6);  // m

TEST(RoundACorner, NormalFollowingIsNotRefused) {
  for (const double speed : {20e-6, 200e-6}) {
    Needle needle;
    needle.moveTo(kBefore);
    needle.streamTo(kCorner, speed);
    needle.streamTo(kBehind, speed);
    needle.streamTo(kCorner, speed);
    needle.run(0.09);
    EXPECT_EQ(needle.refused(), 0) << speed;
    EXPECT_EQ(needle.ended(), "") << speed;
    EXPECT_GT(needle.nearest(), kMargin) << speed;
  }
}

}  // namespace
}  // namespace microinjection
