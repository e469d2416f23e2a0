// The URDF's speeds hold for what the device truly does, also where its own configuration allows more.

#include <deque>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

constexpr int kWindow = 50;  // steps, ms: long beside a count of the device

template <typename Tested>
class SpeedLimitTest : public DriverTest<Tested> {
 protected:
  const Eigen::Vector3d limits_{40e-6, 30e-6, 60e-6};  // m/s

  void SetUp() override {
    this->start();
    this->rig_->driver().limitSpeed(limits_);
  }

  /// Runs, and returns the largest speed of an axis as a share of its limit.
  double fastestShare(double duration, const std::function<void()>& command = nullptr) {
    std::deque<Eigen::Vector3d> places;
    double share = 0;
    this->rig_->run(duration, [&] {
      if (command) command();
      places.push_back(this->rig_->place());
      if (places.size() <= kWindow) return;
      const Eigen::Vector3d way = (places.back() - places.front()).cwiseAbs().array() - 1.01 * Tested::kMotorStep;
      share = std::max(share, way.cwiseQuotient(limits_ * kWindow * 1e-3).maxCoeff());
      places.pop_front();
    });
    return share;
  }
};
TYPED_TEST_SUITE(SpeedLimitTest, AllTested, Names);

TYPED_TEST(SpeedLimitTest, HoldsForMoves) {
  EXPECT_LE(this->rig_->driver().abilities().speed, 60e-6);
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(50e-6, 0, 0), Eigen::Vector3d(0, 50e-6, 0), kPlace}) {
    this->rig_->driver().moveTo(this->rig_->place() + way, 1e-3);
    const double share = this->fastestShare(1);
    EXPECT_LE(share, 1 + 1e-6);
    EXPECT_GT(share, 0.9);
    ASSERT_TRUE(this->rig_->runUntilArrived());
  }
}

TYPED_TEST(SpeedLimitTest, HoldsForWhatIsFarBehindItsSetPoint) {
  // One axis after the other: the speed of the last short move is too fast for the next one.
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(80e-6, 0, 0), Eigen::Vector3d(0, 80e-6, 0), kPlace}) {
    const Eigen::Vector3d goal = this->rig_->place() + way;
    const double share = this->fastestShare(1, [&] { this->rig_->driver().follow(goal, Eigen::Vector3d::Zero()); });
    EXPECT_LE(share, 1 + 1e-6);
    EXPECT_GT(share, 0.8);
    ASSERT_TRUE(this->rig_->runUntilArrived(20));
  }
}

TYPED_TEST(SpeedLimitTest, AFarSetPointIsApproachedInAStraightLine) {
  const Eigen::Vector3d from = this->rig_->place(), way = kPlace.normalized();
  double aside = 0;
  this->fastestShare(6, [&] {
    this->rig_->driver().follow(from + kPlace, Eigen::Vector3d::Zero());
    const Eigen::Vector3d gone = this->rig_->place() - from;
    aside = std::max(aside, (gone - way * way.dot(gone)).norm());
  });
  expectNear(this->rig_->place(), from + kPlace, TypeParam::kStep);
  EXPECT_LT(aside, std::max(1e-6, 2.5 * TypeParam::kStep));
}

}  // namespace
}  // namespace microinjection
