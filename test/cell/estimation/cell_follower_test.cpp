#include "cell/estimation/cell_follower.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

const CellFollower::Properties kFound{40e3, -0.3e-6};

TEST(CellFollower, FollowsInStepsEachOfWhichIsServedBeforeTheNext) {
  CellFollower cell({}, 10e3);
  int steps = 0;
  for (double time = 1; time < 2; time += 1e-3) {
    const auto asked = cell.ask(kFound, time);
    if (!asked) continue;
    ++steps;
    EXPECT_LE(std::log(asked->modulus / cell.served().modulus), CellFollowerConfig().largest_change * 1.001);
    cell.setServed(*asked);
  }
  EXPECT_NEAR(cell.served().modulus, kFound.modulus, 1e-6 * kFound.modulus);
  EXPECT_NEAR(cell.served().height, kFound.height, 1e-12);
  EXPECT_EQ(steps, std::ceil(std::log(4) / CellFollowerConfig().largest_change));
  EXPECT_FALSE(cell.refused());
}

TEST(CellFollower, ModulusAndHeightAreOnTheirWayTogether) {
  CellFollower cell({}, 10e3);
  const auto asked = cell.ask(kFound, 1);
  ASSERT_TRUE(asked);
  EXPECT_NEAR(std::log(asked->modulus / 10e3) / std::log(4), asked->height / kFound.height, 1e-9);
  CellFollower far({}, 10e3);
  EXPECT_NEAR(far.ask({11e3, 1e-6}, 1)->height, 0.2e-6, 1e-12) << "a large rise takes steps, too";
}

TEST(CellFollower, ASmallChangeIsNotWorthIt) {
  CellFollower cell({}, 10e3);
  EXPECT_FALSE(cell.ask({10.03e3, 10e-9}, 1));
  EXPECT_TRUE(cell.ask({10.03e3, 30e-9}, 1));
}

TEST(CellFollower, ReportsThatItIsNotServedAndAsksAgainAfterAWhile) {
  for (const CellFollower::Properties& found : {kFound, CellFollower::Properties{10e3, 0.1e-6}}) {
    CellFollower cell({}, 10e3);
    const auto asked_first = cell.ask(found, 1);
    ASSERT_TRUE(asked_first);
    int asked = 0;
    for (double time = 1.001; time < 2.1; time += 1e-3) asked += cell.ask(found, time).has_value();
    EXPECT_EQ(asked, 2);
    EXPECT_TRUE(cell.refused());
    cell.setServed(*asked_first);
    cell.ask(found, 3);
    EXPECT_FALSE(cell.refused());
  }
}

TEST(CellFollower, FollowsAgainWhenTheSimulatorWasRestarted) {
  CellFollower cell({}, 10e3);
  for (double time = 1; time < 2; time += 1e-3) {
    if (const auto asked = cell.ask({10e3, 0.3e-6}, time)) cell.setServed(*asked);
  }
  EXPECT_NEAR(cell.served().height, 0.3e-6, 1e-12);
  cell.setServed({10e3, 0});
  EXPECT_TRUE(cell.ask({10e3, 0.3e-6}, 3));
}

TEST(CellFollower, GoesOnWhenTimeIsSetBack) {
  CellFollower cell({}, 10e3);
  cell.setServed(*cell.ask(kFound, 100));
  EXPECT_TRUE(cell.ask(kFound, 1));
}

TEST(CellFollower, TheHeightIsBounded) {
  CellFollower cell({}, 10e3);
  for (double time = 1; time < 9; time += 1e-2) {
    if (const auto asked = cell.ask({10e3, 1}, time)) cell.setServed(*asked);
  }
  EXPECT_NEAR(cell.served().height, CellFollowerConfig().largest_height, 1e-12);
}

}  // namespace
}  // namespace microinjection
