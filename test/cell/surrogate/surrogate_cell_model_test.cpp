#include "cell/surrogate/surrogate_cell_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/allocation_count.h"
#include "cell/surrogate/spring_cells.h"

namespace microinjection {
namespace {

TEST(SurrogateCellModel, TrustsOnlyWhatWasPrepared) {
  Scene scene = pipette();
  const auto cell = springs(scene);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), deep(0, 0, 20e-6);
  SurrogateCellModel tracker(scene, cell);
  EXPECT_TRUE(tracker.step({0, 0, 30e-6}, up, 0).valid);
  EXPECT_FALSE(tracker.contact());
  const TipForce force = tracker.step(deep, up, 1e-3);
  EXPECT_TRUE(force.valid);
  EXPECT_NEAR(tracker.contact()->indentation, 8e-6, 1e-15);
  EXPECT_NEAR(tracker.solution(0)->stiffness(2, 2) * 8e-6, force.force.z(), 1e-6 * force.force.z());  // a spring
  EXPECT_FALSE(tracker.step(deep, Eigen::Vector3d(0.2, 0, 1).normalized(), 2e-3).valid);
  EXPECT_NE(tracker.invalidReason(), "");
  const TipForce too_deep = tracker.step({0, 0, -20e-6}, up, 3e-3);  // a force that fades there is felt as a puncture
  EXPECT_FALSE(too_deep.valid);
  EXPECT_TRUE(too_deep.force.isZero(0));
  EXPECT_NE(tracker.invalidReason(), "");
  EXPECT_TRUE(tracker.step(deep + Eigen::Vector3d(15e-6, 0, 0), up, 3.5e-3).valid);  // beside the range it fades
  EXPECT_NE(tracker.invalidReason(), "");
  EXPECT_TRUE(tracker.step(deep, up, 4e-3).valid);
  EXPECT_EQ(tracker.invalidReason(), "");

  SurrogateCellModel beside(scene, cell);  // touches at 75 degrees
  const TipForce far_out = beside.step({ContactFrame::offsetFor(scene, 1.3).x(), 0, 0}, up, 0);
  EXPECT_FALSE(far_out.valid);
  EXPECT_TRUE(far_out.force.isZero(0));
  EXPECT_NE(beside.invalidReason(), "");

  tracker.release();
  EXPECT_FALSE(tracker.contact());
  EXPECT_EQ(tracker.step(deep, up, 5e-3).force, force.force);
}

TEST(SurrogateCellModel, BelowTheRangeANeedleThatRestedMayBeWithdrawnButNotGoOn) {
  const Scene scene = pipette();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  SurrogateCellModel tracker(scene, springs(scene));
  double time = 0;
  const auto step = [&](double z) { return tracker.step({0, 0, z}, up, time += 1e-3).valid; };
  for (double z = 30e-6; z > 0; z -= 0.1e-6) step(z);
  double z = -30e-6;
  EXPECT_FALSE(step(z));
  for (int i = 0; i < 90; ++i) EXPECT_FALSE(step(z)) << "it has hardly rested";
  for (int i = 0; i < 100; ++i) step(z);
  EXPECT_TRUE(step(z + 0.05e-6));
  EXPECT_NE(tracker.invalidReason(), "") << "it says so nevertheless";
  EXPECT_FALSE(step(z -= 0.2e-6)) << "deeper";
  for (int i = 0; i < 200; ++i) step(z);
  for (; z < 30e-6; z += 0.1e-6) ASSERT_TRUE(step(z)) << z;
  EXPECT_EQ(tracker.invalidReason(), "");
}

TEST(SurrogateCellModel, APoseThatIsNoNumberIsNotTrustedAndForgotten) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Scene scene = pipette();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), deep(0, 0, 20e-6);
  SurrogateCellModel tracker(scene, springs(scene));
  EXPECT_FALSE(tracker.step({0, 0, kNan}, up, 0).valid);
  const TipForce before = tracker.step(deep, up, 1e-3);
  ASSERT_TRUE(before.valid && before.force.z() > 0);
  for (const TipForce& force : {tracker.step({kNan, 0, 20e-6}, up, 2e-3), tracker.step(deep, {0, 0, kNan}, 2e-3),
                                tracker.step(deep, up, kNan)}) {
    EXPECT_FALSE(force.valid);
    EXPECT_TRUE(force.force.isZero(0));
    EXPECT_NE(tracker.invalidReason(), "");
  }
  EXPECT_EQ(tracker.step(deep, up, 3e-3).force, before.force);
  EXPECT_TRUE(tracker.contact());
}

/// In and out of the cell at places all over it, sideways, out of the range, tilted, and through puncture.
TEST(SurrogateCellModel, AStepAllocatesNothing) {
  for (const char* shape : {"disc", "hemisphere", "rounded_flat"}) {
    Scene scene = pipette();
    scene.needle.tip.shape = shape;
    if (scene.needle.tip.shape == "rounded_flat") scene.needle.tip.edge_radius = 1e-6;
    const auto cell = springs(scene);
    SurrogateCellModel tracker(scene, cell);
    scene.cell.puncture = PunctureConfig::atForce(1e-9);
    scene.cell.puncture.layers.push_back({"oolemma", 1e-8});
    scene.cell.puncture.layers.back().stiffness = 0.01;
    scene.cell.puncture.shaft = {1e-8, 1e-3, 0.3, 1, 0.01};
    PuncturableCell weak(scene, std::make_unique<SurrogateCellModel>(scene, cell));
    int touched = 0, invalid = 0;
    const std::size_t before = allocationCount();
    for (int i = 0; i < 3000; ++i) {
      const double way = 0.01 * i, side = 20e-6 * std::sin(0.05 * way);
      const Eigen::Vector3d tip(side, 3e-6 * std::sin(7 * way), 20e-6 + 20e-6 * std::cos(way));
      const Eigen::Vector3d axis = i % 10 == 0 ? Eigen::Vector3d(0.6, 0, 0.8) : Eigen::Vector3d::UnitZ();
      if (!tracker.step(tip, axis, 1e-3 * i).valid) ++invalid;
      if (tracker.contact()) ++touched;
      weak.step(tip, axis, 1e-3 * i);
    }
    EXPECT_EQ(allocationCount(), before) << shape;
    EXPECT_GT(touched, 300);
    EXPECT_LT(touched, 2700);
    EXPECT_GT(invalid, 30);
    EXPECT_TRUE(weak.insertion().punctured);
    EXPECT_GT(weak.deformedSurface().holes.size(), 3u);
  }
}

}  // namespace
}  // namespace microinjection
