#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "operation/teleoperation/haptic_bridge.h"
#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

constexpr double kEnd = 15e-3;  // m, the stick's

/// A stick on the bridge as config/haptic/joy.yaml has it, and a needle that goes where it is told.
class Stick {
 public:
  explicit Stick(const std::string& alignment, double bent = 0) : bridge_(config(alignment)), bent_(bent) {
    input.operator_present = true;
    input.force.predicted = Eigen::Vector3d::Zero();
  }

  /// Bends the stick to `deflection` (m) at 10 mm/s and leaves it there for 0.2 s.
  void bendTo(double deflection) {
    while (std::abs(deflection - bent_) > 1e-9) {
      bent_ += std::clamp(deflection - bent_, -1e-5, 1e-5);
      run(1);
    }
    run(200);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      input.hand = Eigen::Vector3d(0, 0, bent_);
      input.needle = Eigen::Vector3d(0, 0, needle);
      const HapticBridge::Output output = bridge_.step(input, kStep);
      state = output.state;
      if (output.needle) needle = output.needle->z();
    }
  }

  HapticBridge::Input input;
  Engagement::State state = Engagement::State::kHeld;
  double needle = 60e-6;  ///< m

 private:
  static HapticBridgeConfig config(const std::string& alignment) {
    HapticBridgeConfig config;
    config.motion.mode = "rate";
    config.motion.rate_gain = 1e-3;
    config.motion.dead_zone = 2e-3;
    config.motion.rate_limit = 20e-6;
    config.engagement.mode = alignment;
    config.require_operator = true;
    return config;
  }
  HapticBridge bridge_;
  double bent_;  ///< m
};

void dropOut(Stick& stick) { stick.input.force.predicted.reset(); }
void clutch(Stick& stick) { stick.input.clutch = true; }
void clutchAndDropOut(Stick& stick) { clutch(stick), dropOut(stick); }
void letGoOfTheDeadMan(Stick& stick) { stick.input.operator_present = false; }

/// Held for 60 ms with the stick at `deflection`, for what `open` does to the input.
void hold(Stick& stick, void (*open)(Stick&)) {
  const HapticBridge::Input good = stick.input;
  open(stick);
  stick.run(60);
  EXPECT_EQ(stick.state, Engagement::State::kHeld);
  stick.input = good;
}

struct Hold {
  const char* name;
  void (*open)(Stick&);
};
const Hold kHolds[] = {{"drop-out", dropOut},
                       {"clutch", clutch},
                       {"clutch and drop-out", clutchAndDropOut},
                       {"dead-man", letGoOfTheDeadMan}};

class RateModeHold : public testing::TestWithParam<const char*> {};

TEST_P(RateModeHold, AStickThatIsLetGoAfterAHoldLeavesTheNeedleAtRest) {
  for (const auto& [name, open] : kHolds) {
    for (const double deflection : {1.9e-3, -3.9e-3, 3.9e-3, -kEnd, kEnd}) {
      Stick stick(GetParam());
      stick.bendTo(0);
      stick.bendTo(deflection);
      hold(stick, open);
      const double before = stick.needle;
      stick.run(300);
      if (std::abs(deflection) > 2e-3) {
        EXPECT_EQ(stick.state, Engagement::State::kAlign) << name << deflection;
      }
      stick.bendTo(0);
      stick.run(1000);
      EXPECT_EQ(stick.needle, before) << name << " at " << deflection << " m: the needle moves with hands off";
      EXPECT_EQ(stick.state, Engagement::State::kFollow) << name << deflection;
      stick.bendTo(-kEnd);
      EXPECT_LT(stick.needle, before - 2e-6) << "the stick leads again";
    }
  }
}

TEST_P(RateModeHold, RepeatedHoldsOnTheWayDoNotShiftTheZero) {
  Stick stick(GetParam());
  stick.bendTo(0);
  for (int i = 1; i <= 8; ++i) {
    stick.bendTo(i * kEnd / 8);
    hold(stick, kHolds[i % 4].open);
    stick.run(60);
  }
  stick.bendTo(0);
  const double before = stick.needle;
  stick.run(5000);
  EXPECT_EQ(stick.needle, before);
}

TEST_P(RateModeHold, AStickThatIsFoundDeflectedIsNotTakenUp) {
  Stick stick(GetParam(), kEnd);
  stick.run(500);
  EXPECT_EQ(stick.needle, 60e-6);
  stick.bendTo(0);
  stick.run(1000);
  EXPECT_EQ(stick.needle, 60e-6);
}

INSTANTIATE_TEST_SUITE_P(BothAlignments, RateModeHold, testing::Values("index", "agree"),
                         [](const auto& which) { return std::string(which.param); });

}  // namespace
}  // namespace microinjection
