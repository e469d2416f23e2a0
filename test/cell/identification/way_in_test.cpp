#include "cell/identification/way_in.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace microinjection {
namespace {

/// A position that goes through the given places at 1 um/s, sampled at 100 Hz, with noise; time counts samples.
struct Path {
  std::vector<double> time, position;

  explicit Path(const std::vector<double>& places, double noise = 0) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, 1);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const double way = places[i + 1] - places[i];
      const int count = way == 0 ? 300 : static_cast<int>(std::abs(way) / 0.01e-6 + 0.5);  // a hold of 3 s
      for (int k = 0; k < count; ++k) {
        time.push_back(0.01 * static_cast<double>(time.size()));
        position.push_back(places[i] + way * (k + 1) / count + noise * normal(random));
      }
    }
  }
  WayIn way() const { return findWayIn(time, position); }
};

TEST(WayIn, IsAllOfAnApproach) {
  const WayIn way = Path({0, 5e-6}).way();
  EXPECT_EQ(way.begin, 0u);
  EXPECT_EQ(way.end, 500u);
  EXPECT_TRUE(way.notes.empty());
}

TEST(WayIn, EndsWhereTheTipRestsOrTurns) {
  for (const double noise : {0.0, 2e-9}) {
    const WayIn held = Path({0, 5e-6, 5e-6, 0}, noise).way();
    EXPECT_NEAR(static_cast<double>(held.end), 500, 10) << noise;
    const WayIn back = Path({0, 5e-6, 0}, noise).way();
    EXPECT_NEAR(static_cast<double>(back.end), 500, 4) << noise;
    EXPECT_FALSE(back.notes.empty());
  }
  const WayIn held = Path({0, 5e-6, 5e-6, 0}).way();
  ASSERT_EQ(held.notes.size(), 2u);
  EXPECT_NE(held.notes[1].find("of a hold are left out"), std::string::npos) << held.notes[1];
}

TEST(WayIn, BeginsAtTheLastTurnOfThreeApproaches) {
  const WayIn way = Path({0, 3e-6, 0, 4e-6, 0, 5e-6, 0}).way();
  EXPECT_NEAR(static_cast<double>(way.begin), 1400, 2);
  EXPECT_NEAR(static_cast<double>(way.end), 1900, 2);
}

TEST(WayIn, AHoldOfOneSampleIsNone) {
  Path path({0, 5e-6});
  path.time.push_back(5.01);
  path.position.push_back(5e-6);
  EXPECT_GE(path.way().end, 500u);
}

/// The tip creeps on under a held force: its speed is a tenth, and the force says more.
TEST(EndOfLoading, IsWhereTheForceIsHeld) {
  const Path path({0, 5e-6});
  std::vector<double> force;
  for (std::size_t i = 0; i < path.time.size(); ++i)
    force.push_back(1e-9 * static_cast<double>(std::min<std::size_t>(i, 350)));
  EXPECT_NEAR(static_cast<double>(endOfLoading(path.time, force)), 350, 10);
  std::iota(force.begin(), force.end(), 0.0);
  EXPECT_EQ(endOfLoading(path.time, force), force.size());
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 1e-9);
  for (double& each : force) each = normal(random);
  EXPECT_EQ(endOfLoading(path.time, force), force.size()) << "noise alone is no hold";
}

TEST(CrestBeforePuncture, IsTheHighestSampleBeforeASuddenFall) {
  const Path path({0, 5e-6});
  std::vector<double> force;
  for (std::size_t i = 0; i < path.time.size(); ++i) force.push_back(1e-9 * static_cast<double>(i < 400 ? i : i - 300));
  const auto crest = crestBeforePuncture(path.position, force);
  ASSERT_TRUE(crest);
  EXPECT_NEAR(static_cast<double>(*crest), 399, 3);
  // The force that comes behind a puncture may be any number of times greater.
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = 1e-9 * (i < 300 ? i : 100 + 6 * (i - 300.0));
  const auto early = crestBeforePuncture(path.position, force);
  ASSERT_TRUE(early);
  EXPECT_NEAR(static_cast<double>(*early), 299, 3);
  // A tip that snaps in punctures nothing.
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = 1e-9 * (i < 300 ? 0 : i - 350.0);
  EXPECT_FALSE(crestBeforePuncture(path.position, force));
  // A fall over a third of the way is a drift, or a cell that relaxes.
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = 1e-9 * (i < 320 ? i : 320 - 0.6 * (i - 320.0));
  EXPECT_FALSE(crestBeforePuncture(path.position, force));
}

}  // namespace
}  // namespace microinjection
