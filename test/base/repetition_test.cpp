#include "base/repetition.h"

#include <gtest/gtest.h>

#include <vector>

namespace microinjection {
namespace {

TEST(Repetition, AReadingMayStayUpToTheLimit) {
  Repetition<double> force(3);
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(force.step(1.5, 1)) << i;  // the first one has no exposure
  EXPECT_TRUE(force.step(1.5, 1));
  EXPECT_TRUE(force.step(1.5, 1));
  EXPECT_FALSE(force.step(1.5 + 1e-15, 1)) << "the smallest change is one";
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(force.step(1.5 + 1e-15, 1));
  EXPECT_TRUE(force.step(1.5 + 1e-15, 1));
}

TEST(Repetition, WithoutExposureAReadingMayStayForEver) {
  Repetition<double> stick(0.5);
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(stick.step(0, 0));
}

TEST(Repetition, OfAWayTheFarthestPlaceCounts) {
  Repetition<double> force(1e-6);
  EXPECT_TRUE(force.changes(2e-7));
  force.exposeTo(0.9e-6);
  EXPECT_FALSE(force.repeats());
  force.exposeTo(1.1e-6);
  force.exposeTo(0.1e-6);
  EXPECT_FALSE(force.changes(2e-7));
  EXPECT_TRUE(force.repeats()) << "nothing was read while the needle came back";
  EXPECT_TRUE(force.changes(2.1e-7));
  EXPECT_FALSE(force.repeats());
}

TEST(Repetition, OfImagesTheFirstOneCounts) {
  Repetition<std::vector<unsigned char>> images(0);
  EXPECT_FALSE(images.step({1, 2, 3}, 1));
  EXPECT_TRUE(images.step({1, 2, 3}, 1));
  EXPECT_FALSE(images.step({1, 2, 4}, 1));
  images.reset();
  EXPECT_FALSE(images.step({1, 2, 4}, 1)) << "of another camera";
}

}  // namespace
}  // namespace microinjection
