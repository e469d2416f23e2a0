#include "operation/display/cell_members.h"

#include <gtest/gtest.h>

#include <limits>

namespace microinjection {
namespace {

CellMembers members() {
  CellMembers result;
  for (int i = 0; i < 6; ++i) result.points.emplace_back(1e-6 * i, 0, 0);
  result.forces = {-3e-7, 2e-7, 0};
  result.kinds = {CellMembers::kStrut, CellMembers::kActin, CellMembers::kIntermediate};
  return result;
}

TEST(CellMembers, AreDrawnTenThousandTimesColouredByTension) {
  EXPECT_EQ(members().defect(), "");
  EXPECT_EQ(members().largestTension(), 2e-7);
  const ColouredLines struts = strutLines(members()), cables = cableLines(members(), 2e-7);
  ASSERT_EQ(struts.lines.size(), 2u);
  ASSERT_EQ(cables.lines.size(), 4u);
  ASSERT_EQ(cables.colours.size(), 4u);
  EXPECT_NEAR(cables.lines[0].x(), 0.02, 1e-12);
  const Colour tense = colourOfFraction(1);
  EXPECT_EQ(cables.colours[0].r, tense.r);
  EXPECT_EQ(cables.colours[2].r, cables.colours[2].g);  // slack: grey
  EXPECT_NE(cableLines(members(), 8e-7).colours[0].r, tense.r);
}

TEST(CellMembers, DefectsAreNamed) {
  CellMembers torn = members(), wild = members();
  torn.points.pop_back();
  wild.forces[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(torn.defect(), "");
  EXPECT_NE(wild.defect(), "");
  EXPECT_EQ(CellMembers().defect(), "");
  EXPECT_EQ(CellMembers().largestTension(), 0);
}

}  // namespace
}  // namespace microinjection
