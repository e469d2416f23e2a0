// A stream of commands that goes on through a fault, as a controller's does: one `enable` is enough, and nothing leaps.

#include <gtest/gtest.h>

#include <map>

#include "cell_microinjection/LoopState.h"
#include "needle_bench.h"

namespace microinjection {
namespace {

/// Its fault, which waits for enable.
const std::map<std::string, std::string> kFaultOfRig = {{"sim", "error:4"},
                                                        {"external", "error:4"},
                                                        {"emulated_zaber", "error:FS"},
                                                        {"emulated_mp285", "silence:5"},
                                                        {"emulated_eppendorf", "silence:5"},
                                                        {"emulated_scientifica", "silence:5"}};

class FaultAndStreamTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; })) << bench_.status();
    where_ = bench_.needle();
    ASSERT_TRUE(where_.allFinite());
  }
  /// What a controller sends that yields to its rig: the needle's place, or where that was last.
  void streamTheNeedle() {
    bench_.world.repeat<NeedleBench::Pose>("needle/servo_cp", [this] {
      if (bench_.needle().allFinite()) where_ = bench_.needle();
      return std::optional(poseAt(where_ + ahead_));
    });
  }
  void fail() {
    bench_.inject(kFaultOfRig.at(GetParam()));
    bench_.run(0.05);
    bench_.move(where_ + Eigen::Vector3d(20e-6, 0, 0));  // that it has something to fail in
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "FAULT"; })) << bench_.state();
    bench_.run(6);  // longer than any silence
    ASSERT_EQ(bench_.state(), "FAULT");
  }
  void enableOnce() {
    bench_.command("enable");
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; })) << bench_.status();
  }
  std::string hold() {
    const auto* state = loop_.newest();
    return state ? state->hold_reason : "nothing heard";
  }

  NeedleBench bench_{GetParam()};
  Probe<cell_microinjection::LoopState>& loop_ = bench_.world.hear<cell_microinjection::LoopState>("needle/loop_state");
  Eigen::Vector3d where_, ahead_ = Eigen::Vector3d::Zero();  // m
};

TEST_P(FaultAndStreamTest, AfterOneEnableTheNeedleFollowsAStreamThatWaitedForIt) {
  streamTheNeedle();
  fail();
  enableOnce();
  EXPECT_TRUE(bench_.until([&] { return hold().empty(); }, 1)) << hold();
  const double start = bench_.needle().x();
  ahead_.x() = 3e-6;  // always that far before the needle
  EXPECT_TRUE(bench_.until([&] { return bench_.needle().x() > start + 20e-6; })) << bench_.status();
}

TEST_P(FaultAndStreamTest, AStreamThatIsElsewhereMovesNothingAndTheReasonIsSaid) {
  bench_.servo(poseAt(where_));
  fail();
  bench_.servo(poseAt(where_ + Eigen::Vector3d(100e-6, 0, 0)));
  enableOnce();
  EXPECT_LE(bench_.strays(2), 2e-6);
  EXPECT_NE(hold().find("or after enable"), std::string::npos) << hold();
  EXPECT_TRUE(contains(bench_.status(), "the needle was stopped; a stream moves it again"));
  bench_.command("enable");  // who sees that, may let it go
  EXPECT_TRUE(bench_.until([&] { return isNear(bench_.needle(), where_ + Eigen::Vector3d(100e-6, 0, 0), 2e-6); }));
}

INSTANTIATE_TEST_SUITE_P(Rigs, FaultAndStreamTest,
                         testing::Values("sim", "external", "emulated_zaber", "emulated_mp285", "emulated_eppendorf",
                                         "emulated_scientifica"),
                         [](const auto& rig) { return rig.param; });

}  // namespace
}  // namespace microinjection
