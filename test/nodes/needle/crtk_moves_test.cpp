// A CRTK client, which stamps nothing, moves the needle.

#include <gtest/gtest.h>

#include "crtk_client.h"

namespace microinjection {
namespace {

class CrtkMoves : public CrtkBench {};

/// The client's own example.
TEST_F(CrtkMoves, StartFromTheSetPointAndAreWaitedFor) {
  const auto start = client_.setpoint();
  ASSERT_TRUE(start);
  EXPECT_TRUE(isAt(*start));
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(0.1e-3, 0.1e-3, 0), {-0.1e-3, -0.1e-3, 0}, {0, 0, 0}}) {
    ASSERT_TRUE(client_.wait(client_.move(*start + way)));
    EXPECT_TRUE(isAt(*start + way));
    ASSERT_TRUE(client_.setpoint());
    EXPECT_TRUE(isNear(*client_.setpoint(), *start + way, 2e-9));
  }
}

TEST_F(CrtkMoves, AreBusyOnceEach) {
  const Eigen::Vector3d there = kCrtkStart + Eigen::Vector3d(0.2e-3, 0, 0);
  for (const Eigen::Vector3d& target : {there, there, kCrtkStart}) {  // the second one has no length
    const std::size_t since = client_.heard().size();
    EXPECT_TRUE(client_.wait(client_.move(target)));
    bench_.run(0.1);
    EXPECT_EQ(client_.busyChanges(since), kBusyOnce);
  }
}

TEST_F(CrtkMoves, AreBusyAgainWhenTheyTakeOver) {
  const std::size_t since = client_.heard().size();
  const CrtkClient::Handle first = setOff();
  EXPECT_TRUE(client_.wait(client_.move(kCrtkStart)));
  EXPECT_TRUE(client_.wait(first));
  EXPECT_TRUE(isAt(kCrtkStart));
  EXPECT_EQ(client_.busyChanges(since), (std::vector<bool>{true, false, true, false}));
  expectSaid("move_cp of /client overridden: by move_cp of /client");
}

TEST_F(CrtkMoves, StreamsOfSetPointsAreFollowedAndNotBusy) {
  const std::size_t since = client_.heard().size();
  for (int step = 0; step < 100; ++step) {
    client_.servo(kCrtkStart + Eigen::Vector3d(0, 0, 1e-6 * step));
    bench_.run(0.005);
  }
  bench_.run(0.1);
  EXPECT_TRUE(isAt(kCrtkStart + Eigen::Vector3d(0, 0, 99e-6)));
  EXPECT_EQ(client_.busyChanges(since), std::vector<bool>());
}

TEST_F(CrtkMoves, VelocitiesWithoutAStampEndWhenTheyAreOld) {
  for (int i = 0; i < 40; ++i) {
    client_.servoVelocity(50e-6);
    bench_.run(0.01);
  }
  expectRests();
  EXPECT_NEAR(bench_.needle().x(), 50e-6 * (39 * 0.01 + 0.1), 0.5e-6);
  EXPECT_FALSE(client_.state().is_busy);
}

}  // namespace
}  // namespace microinjection
