#include "vision/calibration/play.h"

#include <gtest/gtest.h>

#include "benchmark/common/simulated_needle.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kBacklash(2e-6, 0, 1e-6);

TEST(Play, StartsUnknownWhereThereIsBacklash) {
  const Play play(kBacklash, Eigen::Vector3d::Zero());
  EXPECT_FALSE(play.known(0));
  EXPECT_TRUE(play.known(1));
  EXPECT_FALSE(play.known());
}

TEST(Play, AMoveThroughTheBacklashMakesItKnown) {
  Play play(kBacklash, Eigen::Vector3d::Zero());
  play.moveTo(Eigen::Vector3d(1.9e-6, 0, 0));
  EXPECT_FALSE(play.known(0));
  play.moveTo(Eigen::Vector3d(2.1e-6, 0, 0));
  EXPECT_TRUE(play.known(0));
  EXPECT_NEAR(play.tip().x(), 1.1e-6, 1e-15);
  play.moveTo(Eigen::Vector3d(0.5e-6, 0, 0));  // within the play: the tip rests
  EXPECT_NEAR(play.tip().x(), 1.1e-6, 1e-15);
  play.moveTo(Eigen::Vector3d(-2e-6, 0, 0));
  EXPECT_NEAR(play.tip().x(), -1e-6, 1e-15);
}

TEST(Play, TheIntervalHoldsTheTrueTip) {
  SimulatedNeedleConfig truth = drawnNeedle(5);
  SimulatedNeedle needle(truth, Eigen::Vector3d::Zero());
  Play play(truth.value.segment<3>(kBacklashX), Eigen::Vector3d::Zero());
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i < 200; ++i) {
    for (double& coordinate : position) coordinate += 0.8e-6 * needle.normal();
    needle.moveTo(position);
    play.moveTo(position);
    for (int axis = 0; axis < 3; ++axis) {
      const double slack = play.known(axis) ? 1e-12 : 1e-6 + 1e-12;
      EXPECT_NEAR(needle.place()[axis], play.tip()[axis], slack) << i;
    }
  }
  EXPECT_TRUE(play.known());
}

TEST(Play, ACommandBringsTheTipThereFromAnyState) {
  const SimulatedNeedleConfig truth = drawnNeedle(6);
  const Eigen::Vector3d backlash = truth.value.segment<3>(kBacklashX);
  SimulatedNeedle needle(truth, Eigen::Vector3d::Zero());
  Play play(backlash, Eigen::Vector3d::Zero());
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d goal(1e-6 * needle.normal(), 3e-6 * needle.normal(), 20e-6 * needle.normal());
    const std::vector<Eigen::Vector3d> commands = play.commandFor(goal);
    EXPECT_EQ(commands.size(), i == 0 ? 2u : 1u);
    for (const Eigen::Vector3d& position : commands) {
      needle.moveTo(position);
      play.moveTo(position);
    }
    EXPECT_NEAR((needle.place() - goal).norm(), 0, 1e-12) << i;
    EXPECT_NEAR((play.tip() - goal).norm(), 0, 1e-12) << i;
  }
}

TEST(Play, AnAxisThatNeedNotMoveKeepsItsMotor) {
  Play play(kBacklash, Eigen::Vector3d(0, 0, 0));
  play.moveTo(Eigen::Vector3d(10e-6, 0, 10e-6));
  Eigen::Vector3d goal = play.tip();
  goal.x() -= 5e-6;
  const Eigen::Vector3d command = play.commandFor(goal).back();
  EXPECT_EQ(command.z(), 10e-6);
  EXPECT_NEAR(command.x(), goal.x() - 1e-6, 1e-15);
}

TEST(PlayAxis, IsPlayForAPositiveBacklashAndContinuousThroughZero) {
  for (const double from : {-3e-6, 3e-6}) {
    double tips[2];
    int k = 0;
    for (const double half : {-1e-12, 1e-12}) {
      PlayAxis axis{0, 1};
      axis.move(0, from, half);
      axis.move(from, 1e-6, half);
      tips[k++] = axis.tip(half);
    }
    EXPECT_NEAR(tips[0], tips[1], 3e-12);
    EXPECT_NEAR(tips[0], 1e-6, 3e-12);
  }
}

}  // namespace
}  // namespace microinjection
