// A stream of set-points becomes short moves, however long these may be: none is broken off for the next set-point.

#include <algorithm>
#include <cmath>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

template <typename Tested>
using ShortMovesTest = DriverTest<Tested>;
TYPED_TEST_SUITE(ShortMovesTest, AllMoveByMove, Names);

TYPED_TEST(ShortMovesTest, AFarSetPointIsApproachedWithoutABreak) {
  for (const double segment_time : {0.05, 0.1, 0.2, 0.5}) {
    SCOPED_TRACE(segment_time);
    auto config = TypeParam::config();
    config.segment_time = segment_time;
    this->make({}, config);
    this->start();
    auto& rig = *this->rig_;
    const ManipulatorAbilities abilities = rig.driver().abilities();
    const Eigen::Vector3d way(2e-3, 0, 0), goal = rig.place() + way;
    const double begin = rig.time(), moves = std::ceil(way.norm() / (2 * segment_time * abilities.speed)) + 3;
    rig.run(0.1, [&] { rig.driver().follow(goal, Eigen::Vector3d::Zero()); });
    ASSERT_TRUE(rig.runUntil(
        [&] {
          rig.driver().follow(goal, Eigen::Vector3d::Zero());
          return (rig.place() - goal).norm() < 2 * TypeParam::kStep;
        },
        20));
    EXPECT_LE(rig.device().movesBegun(), moves);
    EXPECT_LT(rig.time() - begin, way.norm() / abilities.speed + moves * (abilities.command_interval - segment_time) +
                                      moves * TypeParam::kRamp * abilities.speed);
  }
}

TYPED_TEST(ShortMovesTest, AStreamStandsNoLongerThanATurnTakesBesideItsMove) {
  for (const double segment_time : {0.05, 0.1, 0.2, 0.5}) {
    SCOPED_TRACE(segment_time);
    auto config = TypeParam::config();
    config.segment_time = segment_time;
    this->make({}, config);
    this->start();
    auto& rig = *this->rig_;
    const ManipulatorAbilities abilities = rig.driver().abilities();
    const Eigen::Vector3d velocity(0.1e-3, -0.05e-3, 0.02e-3);
    Eigen::Vector3d goal = rig.place();
    double stands_since = 0, stood = 0, lag = 0;
    const double begin = rig.time();
    rig.run(10, [&] {
      goal += velocity * 1e-3;
      rig.driver().follow(goal, velocity);
      if (rig.device().moves() || rig.time() < begin + 5) stands_since = rig.time();
      stood = std::max(stood, rig.time() - stands_since);
      if (rig.time() > begin + 5) lag = std::max(lag, (goal - rig.place()).norm());
    });
    EXPECT_LT(stood, abilities.command_interval - segment_time + 0.02);
    EXPECT_LT(lag, velocity.norm() * (abilities.latency + abilities.command_interval) + TypeParam::kStep);
    EXPECT_EQ(rig.driver().malformed(), 0);
  }
}

}  // namespace
}  // namespace microinjection
