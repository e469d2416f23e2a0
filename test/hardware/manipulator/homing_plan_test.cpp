#include "hardware/manipulator/homing_plan.h"

#include <gtest/gtest.h>

#include "hardware/manipulator/collision_guard.h"
#include "hardware/manipulator/manipulator_geometry.h"
#include "hardware/manipulator/rig_file.h"

namespace microinjection {
namespace {

constexpr double kEnd = 12.5e-3;  // m, of an axis' travel

class HomingPlanTest : public testing::Test {
 protected:
  HomingPlan plan(const Eigen::Vector3d& ends) const { return planHoming(rig_, guard_, ends); }
  /// Whether the way that the plan takes from there keeps clear.
  std::string blocked(const HomingPlan& plan, Eigen::Vector3d place, const Eigen::Vector3d& ends) const {
    for (const int axis : plan.order) {
      Eigen::Vector3d next = place;
      next[axis] = ends[axis];
      if (std::string why = guard_.blocksPath(place, next); !why.empty()) return why;
      place = next;
    }
    return "";
  }

  ManipulatorGeometry rig_ = ManipulatorGeometry::fromUrdf(rigUrdf());
  CollisionGuard guard_{rigUrdf(), rig_, kMargin};
};

TEST_F(HomingPlanTest, LiftsTheNeedleOutOfTheDishFirst) {
  const Eigen::Vector3d ends(-kEnd, kEnd, kEnd);
  const HomingPlan found = plan(ends);
  EXPECT_EQ(found.refusal, "");
  EXPECT_EQ(found.order[0], 2);
  EXPECT_EQ(blocked(found, Eigen::Vector3d(0, 0, 0), ends), "");         // above the cell
  EXPECT_EQ(blocked(found, Eigen::Vector3d(10e-3, 2e-3, 0), ends), "");  // beside it in the dish
  EXPECT_NE(blocked({{0, 1, 2}, ""}, Eigen::Vector3d(0, 0, 0), ends), "") << "the axes' own order meets the wall";
}

TEST_F(HomingPlanTest, RefusesToEndBelowTheDish) {
  // config/rigs/zaber.yaml as it is: the lower end of z.
  const HomingPlan found = plan(Eigen::Vector3d::Constant(-kEnd));
  EXPECT_NE(found.refusal.find("manipulator_z = -0.0125 m, allowed"), std::string::npos) << found.refusal;
}

TEST_F(HomingPlanTest, RefusesToEndInAnObstacle) {
  const HomingPlan found = plan({12.4e-3, 12.4e-3, 1e-3});  // in the wall, within travel
  EXPECT_NE(found.refusal.find("dish"), std::string::npos) << found.refusal;
}

TEST_F(HomingPlanTest, RefusesWhereNoOrderKeepsClear) {
  // Clear itself, but whoever comes from beside it, at this height, has to cross the dish's wall or its floor.
  const HomingPlan found = plan({0, 0, 2e-3});
  EXPECT_NE(found.refusal.find("no order of the axes"), std::string::npos) << found.refusal;
  EXPECT_NE(found.refusal.find("reference position"), std::string::npos) << found.refusal;
}

TEST_F(HomingPlanTest, ARigWithoutObstaclesHomesAnywhereInItsTravel) {
  EXPECT_EQ(planHoming(rig_, CollisionGuard(), {kEnd, -kEnd, 0}).refusal, "");
}

}  // namespace
}  // namespace microinjection
