#include "operation/display/colour_ranges.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

constexpr auto kDisplacement = SurfaceQuantity::kDisplacement;

CellIdentity cell(double modulus) {
  return {{"young_modulus", "diameter"}, {modulus, 90e-6}, {45e-6, 40e-6}, "neo_hookean"};
}

TEST(ColourRanges, GrowWithTheValuesOfACell) {
  ColourRanges ranges;
  ranges.setCell(cell(10e3));
  EXPECT_DOUBLE_EQ(ranges.include(kDisplacement, {1e-6, 4e-6}), 4e-6);
  EXPECT_DOUBLE_EQ(ranges.include(kDisplacement, {20e-6}), 20e-6);
  ranges.setCell(cell(10e3));
  EXPECT_DOUBLE_EQ(ranges.include(kDisplacement, {2e-6}), 20e-6);
  EXPECT_DOUBLE_EQ(ranges.includeTension(3e-9), 3e-9);
  EXPECT_DOUBLE_EQ(ranges.includeTension(1e-9), 3e-9);
}

TEST(ColourRanges, BeginAnewWithAnotherCell) {
  CellIdentity stiffer = cell(20e3), thinner = cell(10e3), other = cell(10e3), fewer = cell(10e3);
  thinner.radii[1] = 42e-6;
  other.material = "linear";
  fewer.parameters.pop_back();
  for (const CellIdentity& next : {stiffer, thinner, other, fewer}) {
    ColourRanges ranges;
    ranges.setCell(cell(10e3));
    for (const SurfaceQuantity quantity : {kDisplacement, SurfaceQuantity::kPressure}) ranges.include(quantity, {2e6});
    ranges.includeTension(3e-9);
    ranges.setCell(next);
    EXPECT_DOUBLE_EQ(ranges.include(kDisplacement, {2e-6}), 2e-6);
    EXPECT_DOUBLE_EQ(ranges.include(SurfaceQuantity::kPressure, {200}), 200);
    EXPECT_DOUBLE_EQ(ranges.includeTension(1e-9), 1e-9);
  }
}

}  // namespace
}  // namespace microinjection
