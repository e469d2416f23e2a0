#include "vision/measurement/focus_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// A focus axis that moves at 50 um/s, and a camera that sees a tip in focus at `tip` (m).
class FocusRig {
 public:
  explicit FocusRig(double tip, double start = 0) : tip_(tip), position_(start), goal_(start) {}

  FocusSearch::Input input() const {
    return {now_, known_ ? std::optional(position_) : std::nullopt, reading_, image_problem_};
  }
  void command(double goal) { goal_ = goal; }
  void step() {
    now_ += 0.01;
    const double reach = stuck_ ? 0 : 0.5e-6;
    position_ += std::clamp(goal_ - position_, -reach, reach);
    lowest_ = std::min(lowest_, position_);
    highest_ = std::max(highest_, position_);
    if (frozen_ || now_ - exposed_ < 0.033) return;
    exposed_ = now_;
    const double distance = (position_ - tip_) / 3e-6;
    reading_ = FocusSearch::Reading{now_ - late_, 5 + contrast_ * std::exp(-0.5 * distance * distance)};
  }
  /// Runs a search to its end.
  void run(FocusSearch& search) {
    for (int i = 0; i < 200000 && !search.done() && search.failure().empty(); ++i) {
      if (const auto goal = search.step(input())) command(*goal);
      step();
    }
  }

  double tip_, position_, goal_, lowest_ = 0, highest_ = 0;
  double contrast_ = 100, late_ = 0, now_ = 100, exposed_ = 0;
  bool stuck_ = false, known_ = true, frozen_ = false;
  std::string image_problem_;
  std::optional<FocusSearch::Reading> reading_;
};

TEST(FocusSearch, EndsInTheBestPlane) {
  FocusRig rig(2.3e-6);
  FocusSearch search({}, 0);
  rig.run(search);
  ASSERT_TRUE(search.done()) << search.failure();
  EXPECT_NEAR(search.report().height, 2.3e-6, 0.05e-6);
  EXPECT_NEAR(rig.position_, search.report().height, 0.1e-6);
  EXPECT_EQ(search.plane(), 21U);
}

TEST(FocusSearch, AddsPlanesOnTheSideOfThePeak) {
  for (const double tip : {13.4e-6, -11.6e-6}) {
    FocusRig rig(tip, 1e-6);
    FocusSearch search({}, 1e-6);
    rig.run(search);
    ASSERT_TRUE(search.done()) << search.failure();
    EXPECT_NEAR(search.report().height, tip, 0.05e-6);
  }
}

TEST(FocusSearch, StaysWithinItsReach) {
  for (const double tip : {100e-6, -100e-6}) {
    FocusRig rig(tip);
    rig.contrast_ = 1e4;
    rig.tip_ = tip;
    FocusSearchConfig config;
    config.reach = 20e-6;
    FocusSearch search(config, 0);
    // A slope without an end: the sharpness rises towards the far tip.
    for (int i = 0; i < 200000 && !search.done() && search.failure().empty(); ++i) {
      if (const auto goal = search.step(rig.input())) rig.command(*goal);
      rig.step();
      if (rig.reading_) rig.reading_->sharpness = 200 - 1e6 * std::abs(rig.position_ - tip);
    }
    EXPECT_NE(search.failure().find("farthest allowed"), std::string::npos) << search.failure();
    EXPECT_GE(rig.lowest_, -20e-6 - config.take_up - 1e-9);
    EXPECT_LE(rig.highest_, 20e-6 + 1e-9);
  }
}

TEST(FocusSearch, FindsNothingWhereNothingChanges) {
  FocusRig rig(0);
  rig.contrast_ = 0;
  FocusSearch search({}, 0);
  rig.run(search);
  EXPECT_NE(search.failure().find("no peak"), std::string::npos) << search.failure();
}

TEST(FocusSearch, RefusesOldAndMissingImages) {
  FocusRig late(0);
  late.late_ = 1e3;
  FocusSearch search({}, 0);
  late.run(search);
  EXPECT_NE(search.failure().find("the images are stale"), std::string::npos) << search.failure();
  FocusRig frozen(0);
  for (int i = 0; i < 10; ++i) frozen.step();
  frozen.frozen_ = true;
  FocusSearch second({}, 0);
  frozen.run(second);
  EXPECT_NE(second.failure().find("the images are stale"), std::string::npos) << second.failure();
  FocusRig blind(0);
  blind.frozen_ = true;
  blind.image_problem_ = "it is black";
  FocusSearch third({}, 0);
  blind.run(third);
  EXPECT_NE(third.failure().find("it is black"), std::string::npos) << third.failure();
}

TEST(FocusSearch, TakesNoImageOfAnotherPlane) {
  // Images come 0.2 s late: each must have been exposed after the focus has arrived.
  FocusRig rig(2.3e-6);
  rig.late_ = 0.2;
  FocusSearch search({}, 0);
  rig.run(search);
  ASSERT_TRUE(search.done()) << search.failure();
  EXPECT_NEAR(search.report().height, 2.3e-6, 0.05e-6);
}

TEST(FocusSearch, FailsWithoutAnAxis) {
  FocusRig stuck(0);
  stuck.stuck_ = true;
  FocusSearch search({}, 0);
  stuck.run(search);
  EXPECT_NE(search.failure().find("does not answer"), std::string::npos) << search.failure();
  FocusRig lost(0);
  FocusSearch second({}, 0);
  second.step(lost.input());
  lost.known_ = false;
  second.step(lost.input());
  EXPECT_NE(second.failure().find("does not answer"), std::string::npos) << second.failure();
}

TEST(FocusSearch, FailsWhenAnotherCommandsTheFocus) {
  FocusRig rig(0);
  FocusSearch search({}, 0);
  for (int i = 0; i < 5000 && search.failure().empty(); ++i) {
    if (const auto goal = search.step(rig.input())) rig.command(*goal);
    rig.step();
    if (search.plane() == 3) rig.command(50e-6);
  }
  EXPECT_NE(search.failure().find("by itself"), std::string::npos) << search.failure();
}

TEST(FocusSearch, RefusesWhatIsNotFinite) {
  EXPECT_FALSE(FocusSearch({}, std::numeric_limits<double>::quiet_NaN()).failure().empty());
  FocusRig rig(0);
  FocusSearch search({}, 0);
  for (int i = 0; i < 5000 && search.failure().empty(); ++i) {
    if (const auto goal = search.step(rig.input())) rig.command(*goal);
    rig.step();
    if (rig.reading_) rig.reading_->sharpness = std::numeric_limits<double>::infinity();
  }
  EXPECT_NE(search.failure().find("not finite"), std::string::npos) << search.failure();
}

}  // namespace
}  // namespace microinjection
