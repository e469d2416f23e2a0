#include "hardware/sensor/overload_latch.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(OverloadLatch, NamesTheLargestLoadAndTheUnitThatWasMeant) {
  OverloadLatch latch({2e-3, 4e-3});
  latch.check({1.9e-3, -3.9e-3});
  EXPECT_EQ(latch.text(), "");
  latch.check({3e-3, 0});
  EXPECT_EQ(latch.text(), "0.003 N along the pipette, 1.5 times axial_overload = 0.002 N");
  latch.check({0, -2});
  latch.check({0, 0});
  EXPECT_EQ(latch.text(), "2 N across the pipette, 500 times lateral_overload = 0.004 N (mN for N?)");
  latch.check({4000, 0});
  EXPECT_EQ(latch.text(), "4000 N along the pipette, 2e+06 times axial_overload = 0.002 N (uN for N?)");
  latch.reset();
  EXPECT_EQ(latch.text(), "");
  EXPECT_FALSE(latch.latched());
  EXPECT_EQ(latch.limit(), Eigen::Vector2d(2e-3, 4e-3));
}

}  // namespace
}  // namespace microinjection
