#include "operation/display/triangle_soup.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "soup_measures.h"

namespace microinjection {
namespace {

TEST(Lathe, TurnsASolidCylinderThatFacesOutwards) {
  const TriangleSoup soup = lathe({{0, 0}, {2, 0}, {2, 3}, {0, 3}}, 24);
  EXPECT_TRUE(isClosed(soup));
  EXPECT_NEAR(signedVolume(soup), M_PI * 4 * 3 * polygonFactor(24), 1e-12);
}

TEST(Lathe, TurnsATubeWithoutItsBore) {
  const TriangleSoup soup = lathe({{1, 0}, {2, 0}, {2, 3}, {1, 3}, {1, 0}}, 16);
  EXPECT_TRUE(isClosed(soup));
  EXPECT_NEAR(signedVolume(soup), M_PI * (4 - 1) * 3 * polygonFactor(16), 1e-12);
}

TEST(Lathe, FollowsTheDirectionOfTheProfile) {
  EXPECT_LT(signedVolume(lathe({{0, 3}, {2, 3}, {2, 0}, {0, 0}}, 24)), 0);
}

TEST(Lathe, LeavesOutTrianglesWithoutAreaOnTheAxis) {
  const TriangleSoup cone = lathe({{0, 0}, {1, 0}, {0, 1}}, 8);
  EXPECT_EQ(cone.points.size(), 3U * (8 + 8));
  EXPECT_TRUE(isClosed(cone));
}

TEST(Lathe, RefusesFewerThanThreeSegments) { EXPECT_THROW(lathe({{1, 0}, {1, 1}}, 2), std::invalid_argument); }

}  // namespace
}  // namespace microinjection
