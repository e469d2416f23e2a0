#include "vision/measurement/touch_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace microinjection {
namespace {

/// A needle that follows its set-points, a cell `gap` (m) below it, and a camera with noise. In the image the
/// outline is `seen_lower_` (m) below the cell.
class TouchRig {
 public:
  explicit TouchRig(double gap) : gap_(gap) {}

  TouchSearch::Input input() const {
    TouchSearch::Input input{now_, position_, rested_, observation_, image_problem_, force_, force_stamp_};
    if (!known_) input.position.reset();
    return input;
  }
  void run(TouchSearch& search) {
    for (int i = 0; i < 100000 && !search.done() && search.failure().empty(); ++i) {
      const auto setpoint = search.step(input());
      now_ += 0.005;
      if (setpoint && !stuck_ && *setpoint != position_) {
        position_ = *setpoint;
        rested_ = now_;
      }
      const double depth = std::max(0.0, start_.z() - position_.z() - gap_);
      const bool fresh = now_ - force_stamp_ >= force_period_;
      if (force_ && fresh) force_ = kOffset + kBit * std::round((stiffness_ * depth + force_noise_(random_)) / kBit);
      if (fresh) force_stamp_ = now_;
      deepest_ = std::max(deepest_, depth);
      if (frozen_ || now_ - exposed_ < 0.033) continue;
      exposed_ = now_;
      const double above = position_.z() - start_.z() + gap_ + seen_lower_;
      observation_ = TouchSearch::Observation{now_ - late_, kPixels * give_ * depth + noise_(random_), kNoise,
                                              kPixels * above + noise_(random_), above > certain_from_};
      if (!observation_->certain) observation_->gap += astray_;
    }
  }

  Eigen::Vector3d start_{0, 0, 60e-6}, position_ = start_;
  double gap_, now_ = 10, rested_ = 9, exposed_ = 0, late_ = 0, stiffness_ = 0.1, deepest_ = 0;
  double give_ = 0.8, seen_lower_ = 0, certain_from_ = -1, astray_ = 0;  ///< 1, m, m above the outline, px
  bool known_ = true, stuck_ = false, frozen_ = false;
  std::optional<double> force_ = kOffset;
  double force_stamp_ = 10, force_period_ = 0;  ///< s
  std::optional<TouchSearch::Observation> observation_;
  std::string image_problem_;

 private:
  static constexpr double kPixels = 4e6, kNoise = 0.2;        // px/m, px
  static constexpr double kOffset = 0.1e-6, kBit = 0.015e-6;  // N
  std::mt19937 random_{5};
  std::normal_distribution<double> noise_{0, kNoise}, force_noise_{0, 10e-9};  // px, N
};

TouchSearch searchOf(const TouchRig& rig, const TouchSearchConfig& config = {}) {
  return {config, rig.start_, -Eigen::Vector3d::UnitZ(), rig.input()};
}

TEST(TouchSearch, FindsTheTouchAndStopsThere) {
  for (const double gap : {4.1e-6, 12.7e-6}) {
    TouchRig rig(gap);
    TouchSearch search = searchOf(rig);
    rig.run(search);
    ASSERT_TRUE(search.done()) << search.failure();
    EXPECT_NEAR(search.touchTravel(), gap, 0.3e-6);
    EXPECT_NEAR(search.contact().z(), rig.start_.z() - gap, 0.3e-6);
    EXPECT_LT(rig.deepest_, 2.5e-6);
  }
}

// Of white noise of 10 nN in steps of 15 nN. One reading of it is 11 nN off, the difference of two means 3.5 nN.
TEST(TouchSearch, TheForceIsTheMeanOfTheRest) {
  for (int i = 0; i < 10; ++i) {
    TouchRig rig(4.1e-6 + 0.7e-6 * i);
    rig.stiffness_ = 0.015;
    TouchSearch search = searchOf(rig);
    rig.run(search);
    ASSERT_TRUE(search.done()) << search.failure();
    EXPECT_NEAR(*search.restingForce(), rig.stiffness_ * rig.deepest_, 12e-9);
  }
}

TEST(TouchSearch, EachReadingOfTheForceCountsOnce) {
  TouchRig rig(4e-6);
  rig.force_period_ = 0.05;
  TouchSearch search = searchOf(rig);
  const double began = rig.now_;
  rig.run(search);
  ASSERT_TRUE(search.done()) << search.failure();
  const double steps = std::round(search.travel() / TouchSearchConfig().step);
  EXPECT_GE(rig.now_ - began, 19 * rig.force_period_ * steps);
}

TEST(TouchSearch, AForceThatStaysTheSameReadingEndsIt) {
  TouchRig rig(4e-6);
  rig.force_period_ = std::numeric_limits<double>::infinity();
  TouchSearch search = searchOf(rig);
  rig.run(search);
  EXPECT_NE(search.failure().find("more readings of the force at rest"), std::string::npos) << search.failure();
}

TEST(TouchSearch, WaitsForReadingsOfTheForce) {
  TouchRig rig(4e-6);
  TouchSearchConfig config;
  config.settle_time = 0;
  TouchSearch search = searchOf(rig, config);
  const double began = rig.now_;
  rig.run(search);
  ASSERT_TRUE(search.done()) << search.failure();
  const double steps = std::round(search.travel() / config.step);
  EXPECT_GE(rig.now_ - began, 20 * 0.005 * steps);
}

TEST(TouchSearch, ANeedleBeforeOrBehindTheCellIsHeld) {
  TouchRig rig(4e-6);
  rig.give_ = 0;
  rig.stiffness_ = 0.05;  // the depth ends it, not the force
  TouchSearch search = searchOf(rig);
  rig.run(search);
  EXPECT_FALSE(search.done());
  EXPECT_NE(search.failure().find("does not give way"), std::string::npos) << search.failure();
  EXPECT_LT(rig.deepest_, TouchSearchConfig().largest_depth + 0.5e-6);
}

TEST(TouchSearch, ATouchFarFromTheOutlineIsAnotherContact) {
  TouchRig rig(4e-6);
  rig.seen_lower_ = 6e-6;
  TouchSearch search = searchOf(rig);
  rig.run(search);
  EXPECT_FALSE(search.done());
  EXPECT_NE(search.failure().find("another contact"), std::string::npos) << search.failure();
}

TEST(TouchSearch, AnUncertainTipCountsWhereTheTravelHasIt) {
  TouchRig rig(4.1e-6);
  rig.certain_from_ = 2e-6;
  TouchSearch search = searchOf(rig);
  rig.run(search);
  ASSERT_TRUE(search.done()) << search.failure();
  EXPECT_NEAR(search.touchTravel(), rig.gap_, 0.3e-6);
  // What is seen in place of the tip has another gap.
  TouchRig astray(4.1e-6);
  astray.certain_from_ = 2e-6;
  astray.astray_ = -23;
  TouchSearch second = searchOf(astray);
  astray.run(second);
  ASSERT_TRUE(second.done()) << second.failure();
  EXPECT_NEAR(second.touchTravel(), astray.gap_, 0.3e-6);
  EXPECT_NEAR(*second.outlineTravel(), astray.gap_, 0.3e-6);
  TouchRig never(4.1e-6);
  never.certain_from_ = 1;
  TouchSearch third = searchOf(never);
  never.run(third);
  EXPECT_NE(third.failure().find("a certain cell and tip"), std::string::npos) << third.failure();
  EXPECT_EQ(never.position_, never.start_);
}

TEST(TouchSearch, DoesNotBeginAtTheCell) {
  TouchRig rig(4e-6);
  rig.seen_lower_ = -5e-6;
  TouchSearch search = searchOf(rig);
  rig.run(search);
  EXPECT_NE(search.failure().find("begin above it"), std::string::npos) << search.failure();
  EXPECT_EQ(rig.position_, rig.start_);
}

TEST(TouchSearch, EndsWithItsTravel) {
  TouchRig rig(100e-6);
  TouchSearchConfig config;
  config.largest_travel = 10e-6;
  TouchSearch search = searchOf(rig, config);
  rig.run(search);
  EXPECT_NE(search.failure().find("no touch within 10 um"), std::string::npos) << search.failure();
  EXPECT_GE(rig.position_.z(), rig.start_.z() - 10e-6 - 1e-9);
}

TEST(TouchSearch, EndsWithTheForce) {
  TouchRig rig(4e-6);
  rig.stiffness_ = 10;
  TouchSearch search = searchOf(rig);
  rig.run(search);
  EXPECT_NE(search.failure().find("uN, allowed"), std::string::npos) << search.failure();
  EXPECT_LT(rig.deepest_, 0.5e-6);
  EXPECT_FALSE(search.step(rig.input()));
}

TEST(TouchSearch, EndsWhenAForceIsLost) {
  TouchRig rig(4e-6);
  TouchSearch search = searchOf(rig);
  rig.force_.reset();
  rig.run(search);
  EXPECT_NE(search.failure().find("force is not known"), std::string::npos) << search.failure();
}

TEST(TouchSearch, EndsWithoutFreshImages) {
  TouchRig late(4e-6), frozen(4e-6), blind(4e-6);
  late.late_ = 100;
  frozen.frozen_ = blind.frozen_ = true;
  frozen.observation_ = TouchSearch::Observation{9.9, 0, 0.2, 16};
  blind.image_problem_ = "the cell is not seen";
  for (TouchRig* rig : {&late, &frozen, &blind}) {
    TouchSearch search = searchOf(*rig);
    rig->run(search);
    EXPECT_NE(search.failure().find("no fresh image"), std::string::npos) << search.failure();
    EXPECT_NE(search.failure().find(rig->image_problem_), std::string::npos) << search.failure();
    EXPECT_EQ(rig->position_, rig->start_);
  }
}

TEST(TouchSearch, EndsWhenTheNeedleDoesNotFollow) {
  TouchRig rig(4e-6);
  rig.stuck_ = true;
  TouchSearch search = searchOf(rig);
  rig.run(search);
  EXPECT_NE(search.failure().find("does not follow"), std::string::npos) << search.failure();
  TouchRig lost(4e-6);
  TouchSearch second = searchOf(lost);
  lost.known_ = false;
  lost.run(second);
  EXPECT_NE(second.failure().find("position is not known"), std::string::npos) << second.failure();
  TouchRig aside(4e-6);
  TouchSearch third = searchOf(aside);
  aside.position_.x() += 2e-6;
  third.step(aside.input());
  EXPECT_NE(third.failure().find("left the line"), std::string::npos) << third.failure();
}

TEST(TouchSearch, RefusesWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const TouchSearch::Observation& observation :
       {TouchSearch::Observation{11, kNan, 0.2, 16}, TouchSearch::Observation{11, 0, kNan, 16},
        TouchSearch::Observation{11, 0, 0.2, kNan}}) {
    TouchRig rig(4e-6);
    rig.frozen_ = true;
    rig.observation_ = observation;
    TouchSearch search = searchOf(rig);
    rig.run(search);
    EXPECT_NE(search.failure().find("not finite"), std::string::npos) << search.failure();
  }
}

}  // namespace
}  // namespace microinjection
