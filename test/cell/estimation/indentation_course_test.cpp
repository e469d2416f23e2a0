#include "cell/estimation/indentation_course.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using Event = IndentationCourse::Event;
constexpr IndentationCourse::Cell kRoundCell{28e-6, 33e-6};

Eigen::Vector3d at(double depth) { return {0, 0, kRoundCell.surface - depth}; }

PuncturePrediction expected(double depth) {
  PuncturePrediction prediction;
  prediction.depth = depth;
  return prediction;
}

/// Down to `depth` (m) in steps of 0.1 um, with `punctures` counted.
Event lower(IndentationCourse& indentation, double depth, unsigned punctures) {
  Event event = Event::kNone;
  for (double reached = -10e-6; reached <= depth + 1e-9; reached += 0.1e-6) {
    event = indentation.follow(at(reached), kRoundCell, punctures);
    indentation.expect(expected(reached));
  }
  return event;
}

TEST(IndentationCourse, BeginsAtTheSurfaceAndEndsInTheClear) {
  IndentationCourse indentation;
  EXPECT_FALSE(indentation.clear());
  lower(indentation, 4e-6, 0);
  EXPECT_TRUE(indentation.clear());
  EXPECT_TRUE(indentation.touched());
  EXPECT_NEAR(indentation.depth(), 4e-6, 0.2e-6);
  EXPECT_EQ(indentation.follow(at(-2e-6), kRoundCell, 0), Event::kNone);  // not clear yet
  EXPECT_NEAR(indentation.depth(), 4e-6, 0.2e-6);
  EXPECT_EQ(indentation.follow(at(-6e-6), kRoundCell, 0), Event::kEnded);
  EXPECT_FALSE(indentation.touched());
  EXPECT_EQ(indentation.follow(at(-6e-6), kRoundCell, 0), Event::kNone);
}

TEST(IndentationCourse, APunctureCountsOnceAndOnlyInTheCell) {
  IndentationCourse indentation;
  EXPECT_EQ(lower(indentation, 4e-6, 3), Event::kNone);  // of earlier cells
  EXPECT_EQ(indentation.follow(at(4e-6), kRoundCell, 4), Event::kPunctured);
  EXPECT_EQ(indentation.follow(at(4e-6), kRoundCell, 5), Event::kNone);
  indentation.follow(at(9e-6), kRoundCell, 5);
  EXPECT_NEAR(indentation.depth(), 4e-6, 0.2e-6);  // until the puncture
  EXPECT_EQ(indentation.follow(at(-6e-6), kRoundCell, 5), Event::kEnded);
  EXPECT_FALSE(indentation.punctured());
}

TEST(IndentationCourse, APunctureOfATipThatIsNotThereIsNone) {
  IndentationCourse indentation;
  EXPECT_EQ(indentation.follow(at(-20e-6), kRoundCell, 0), Event::kNone);
  EXPECT_EQ(indentation.follow(at(-20e-6), kRoundCell, 1), Event::kNone);
  EXPECT_EQ(indentation.follow(at(2e-6), kRoundCell, std::nullopt), Event::kNone);
}

TEST(IndentationCourse, KnowsWhatWasExpectedAtHalfOfItsDepth) {
  IndentationCourse indentation;
  EXPECT_FALSE(indentation.expectedAtHalf());
  lower(indentation, 4e-6, 0);
  indentation.learn(6e-6);  // the surface was higher
  EXPECT_NEAR(indentation.depth(), 6e-6, 1e-9);
  EXPECT_NEAR(indentation.expectedAtHalf()->depth, 3e-6, 0.2e-6);
}

TEST(IndentationCourse, AtRestNothingGrows) {
  IndentationCourse indentation;
  lower(indentation, 4e-6, 0);
  for (int i = 0; i < 100000; ++i) {
    indentation.learn(4e-6 + 1e-9 * (i % 2));
    indentation.expect(expected(1));
  }
  EXPECT_NEAR(indentation.expectedAtHalf()->depth, 2e-6, 0.2e-6);
}

TEST(IndentationCourse, TheLargestForceIsThatInContact) {
  IndentationCourse indentation;
  indentation.follow(at(-20e-6), kRoundCell, 0);
  indentation.addForce(5e-6);
  EXPECT_EQ(indentation.peak(), 0);
  lower(indentation, 4e-6, 0);
  indentation.addForce(2e-6);
  indentation.addForce(1e-6);
  EXPECT_EQ(indentation.peak(), 2e-6);
  EXPECT_NEAR(indentation.sideways(at(4e-6) + Eigen::Vector3d(2e-6, 0, 0)), 2e-6, 1e-12);
}

}  // namespace
}  // namespace microinjection
