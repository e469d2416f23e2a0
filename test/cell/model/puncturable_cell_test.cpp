#include "cell/model/puncturable_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cell/model/live_cell_model.h"
#include "cell/model/p1_cell.h"
#include "cell/model/puncture_drive.h"

namespace microinjection {
namespace {

TEST(PuncturableCell, IsTheInnerCellUntilALayerFails) {
  PunctureDrive drive({}), whole(PunctureConfig::atForce(1e-6));
  EXPECT_NEAR(drive.toDepth(30e-6), kStiffness * 30e-6, 1e-15);  // nothing to puncture
  EXPECT_FALSE(drive.cell->insertion().punctured);
  EXPECT_NEAR(whole.toDepth(9.9e-6), kStiffness * 9.9e-6, 1e-15);
  EXPECT_FALSE(whole.cell->insertion().inside);
  EXPECT_EQ(whole.layers(), 0);
  EXPECT_EQ(whole.cell->insertion().depth, 0);
  EXPECT_TRUE(whole.cell->deformedSurface().holes.empty());
  EXPECT_EQ(whole.cell->layers(), std::vector<std::string>{"zona"});
}

/// Depths just short of and just past what each criterion means on paper.
TEST(PuncturableCell, TheZonaFailsByForceDepthOrStrain) {
  PunctureConfig force = PunctureConfig::atForce(0.8e-6), depth = PunctureConfig::atForce(INFINITY), strain = depth;
  depth.layers[0].depth = 8e-6;
  // From the disc's rim at 3 um to 9 um: a cone of 6 um by 8 um has a side of 10 um.
  strain.layers[0].strain = 10.0 / 6 - 1;
  strain.layers[0].dimple_radius = 9e-6;
  for (const PunctureConfig& config : {force, depth, strain}) {
    PunctureDrive drive(config);
    drive.toDepth(7.99e-6);
    EXPECT_EQ(drive.layers(), 0);
    drive.toDepth(8.03e-6);
    EXPECT_EQ(drive.layers(), 1);
    EXPECT_TRUE(drive.cell->insertion().inside);
    EXPECT_NEAR(drive.cell->insertion().depth, 8.03e-6, 1e-12);
    EXPECT_EQ(drive.spring->released, 1);
    EXPECT_NEAR(drive.largest, 0.8e-6, 0.003e-6);
    ASSERT_EQ(drive.cell->deformedSurface().holes.size(), 1u);
    EXPECT_TRUE(drive.cell->deformedSurface().holes[0].isApprox(Eigen::Vector3d(0, 0, kTop)));
  }
}

/// A live cell in virtual time: whole to the stated force, at rest after it, and touched again elsewhere.
TEST(PuncturableCell, ServesALiveCell) {
  Scene scene = sceneOf(PunctureConfig::atForce(0.5e-6));
  scene.cell.material() = {"linear", 17.9e3, 0.45};
  scene.mesh.size = 20e-6;
  LiveCellModelConfig config;
  config.fixed_period = true;
  PuncturableCell cell(scene, std::make_unique<LiveCellModel>(std::make_shared<const P1Cell>(scene), config));
  Eigen::Vector3d tip(0, 0, 32e-6);
  double time = 0, largest = 0;
  const auto to = [&](double height) {
    for (const double step = 0.05e-6 * (height < tip.z() ? -1 : 1); (height - tip.z()) * step > 0; tip.z() += step) {
      largest = std::max(largest, cell.step(tip, kAxis, time += 1e-3).force.z());
    }
  };
  to(20e-6);
  EXPECT_EQ(cell.insertion().layers_punctured, 1);
  EXPECT_DOUBLE_EQ(largest, 0.5e-6);
  EXPECT_TRUE(cell.step(tip, kAxis, time + 0.1).force.isZero(0));
  const CellModel::DeformedSurface picture = cell.deformedSurface();
  EXPECT_EQ(picture.holes.size(), 1u);
  EXPECT_EQ(*std::max_element(picture.displacement.begin(), picture.displacement.end()), 0);
  to(32e-6);
  largest = 0;
  to(25e-6);
  EXPECT_EQ(largest, 0);
  to(32e-6);
  tip.x() = 8e-6;
  for (int i = 0; i < 100; ++i) cell.step(tip, kAxis, time += 1e-3);
  to(25.5e-6);
  EXPECT_GT(largest, 0.05e-6);
  EXPECT_LT(largest, 0.5e-6);
}

TEST(PuncturableCell, AnUntrustedForcePuncturesNothing) {
  PunctureConfig config = PunctureConfig::atForce(1e-6);
  PunctureDrive drive(config);
  drive.spring->valid = false;
  drive.toDepth(15e-6);
  EXPECT_EQ(drive.layers(), 0);
  EXPECT_FALSE(drive.cell->step(drive.tip, kAxis, drive.time + 1e-3).valid);
}

/// The tip rests where the zona fails: the force falls to 1/e in the relaxation time, and to exactly nothing.
TEST(PuncturableCell, TheForceFallsInTheRelaxationTime) {
  PunctureDrive drive(PunctureConfig::atForce(1e-6), 10000);
  drive.toDepth(10e-6 + 1e-12);
  EXPECT_DOUBLE_EQ(drive.force.z(), 1e-6);
  EXPECT_NEAR(drive.rest(2e-3), std::exp(-1) * 1e-6, 1e-12);
  EXPECT_EQ(drive.rest(50e-3), 0);
}

TEST(PuncturableCell, LayerAfterLayer) {
  PunctureDrive drive(oocyte());
  EXPECT_EQ(drive.cell->layers(), (std::vector<std::string>{"zona", "oolemma"}));
  drive.toDepth(10.02e-6);
  EXPECT_EQ(drive.layers(), 1);
  EXPECT_NEAR(drive.toDepth(11.9e-6), kFriction, 1e-12);  // across the gap: friction only
  EXPECT_NEAR(drive.toDepth(17e-6), kFriction + 0.02 * 5e-6, 0.5e-9);
  EXPECT_EQ(drive.layers(), 1);
  EXPECT_NEAR(drive.toDepth(21.9e-6), kFriction + 0.02 * 9.9e-6, 0.5e-9);
  EXPECT_EQ(drive.layers(), 1);
  drive.toDepth(22.1e-6);
  EXPECT_EQ(drive.layers(), 2);
  EXPECT_NEAR(drive.toDepth(24e-6), kFriction, 1e-12);
  EXPECT_NEAR(drive.cell->contact()->indentation, 24e-6, 1e-12);
  EXPECT_DOUBLE_EQ(drive.toDepth(20e-6), -kFriction);  // a pull
  EXPECT_DOUBLE_EQ(drive.toDepth(0.1e-6), -kFriction);
  drive.toDepth(-5e-6);
  EXPECT_EQ(drive.force.z(), 0);
  EXPECT_DOUBLE_EQ(drive.smallest, -kFriction);
  EXPECT_FALSE(drive.cell->insertion().inside);
  EXPECT_EQ(drive.cell->insertion().depth, 0);
  EXPECT_EQ(drive.layers(), 2);
  EXPECT_TRUE(drive.cell->insertion().punctured);
  EXPECT_FALSE(drive.cell->contact());
}

TEST(PuncturableCell, TheOolemmaFailsByDepthOrStrainToo) {
  PunctureConfig depth = oocyte(), strain;
  depth.layers[1].force = INFINITY;
  strain = depth;
  depth.layers[1].depth = 8e-6;
  strain.layers[1].strain = 10.0 / 6 - 1;
  strain.layers[1].dimple_radius = 9e-6;
  for (const PunctureConfig& config : {depth, strain}) {
    PunctureDrive drive(config);
    drive.toDepth(19.98e-6);  // 10 um zona, 2 um gap, 8 um
    EXPECT_EQ(drive.layers(), 1);
    drive.toDepth(20.06e-6);
    EXPECT_EQ(drive.layers(), 2);
  }
}

TEST(PuncturableCell, APoseThatIsNotFiniteChangesNothing) {
  PunctureDrive drive(oocyte()), same(oocyte());
  for (PunctureDrive* each : {&drive, &same}) each->toDepth(14e-6);
  const TipForce bad = drive.cell->step({0, NAN, 0}, kAxis, drive.time);
  EXPECT_FALSE(bad.valid);
  EXPECT_TRUE(bad.force.isZero(0));
  EXPECT_NE(drive.cell->invalidReason(), "");
  EXPECT_FALSE(drive.cell->step(drive.tip, kAxis, NAN).valid);
  EXPECT_EQ(drive.toDepth(13e-6), same.toDepth(13e-6));
  EXPECT_EQ(drive.cell->invalidReason(), "");
}

TEST(PuncturableCell, SamePathSameBitsAndNearlySameAtAnyRate) {
  PunctureConfig config = oocyte();
  config.shaft = {kFriction, 1e-3, 0.3, 5, 0.01};
  PunctureDrive slow(config), again(config), fast(config, 10000);
  for (const double depth : {10.5e-6, 9e-6, 16e-6, 25e-6, 20e-6, 26e-6, 5e-6, -3e-6, 12e-6}) {
    EXPECT_EQ(slow.toDepth(depth), again.toDepth(depth));
    fast.toDepth(depth);
    EXPECT_NEAR(slow.force.z(), fast.force.z(), 2e-9) << depth;
    EXPECT_EQ(slow.layers(), fast.layers());
  }
  EXPECT_NEAR(slow.work, fast.work, 0.01 * fast.work);
  EXPECT_NEAR(slow.largest, fast.largest, 1e-9);
}

/// In and out and about: the needle never gets more work back than it has done.
TEST(PuncturableCell, GivesNoEnergy) {
  PunctureConfig config = oocyte();
  config.shaft = {kFriction, 2e-3, 0.3, 5, 0.02};
  for (const double speed : {5e-6, 50e-6, 500e-6, 5e-3}) {
    PunctureDrive drive(config);
    const std::vector<Eigen::Vector3d> places = {{0, 0, 17.9e-6}, {0, 0, 28.5e-6},  {3e-6, 0, 17e-6}, {0, 2e-6, 13e-6},
                                                 {0, 0, 5e-6},    {3e-6, 0, 12e-6}, {0, 0, 30e-6},    {8e-6, 0, 10e-6},
                                                 {8e-6, 0, 4e-6}, {8e-6, 0, 28e-6}};
    double before = 0;
    for (int round = 0; round < 10; ++round) {
      for (const Eigen::Vector3d& place : places) drive.moveTo(place, speed);
      EXPECT_GE(drive.work, before) << speed << " round " << round;  // a closed cycle
      before = drive.work;
    }
    EXPECT_GE(drive.least_work, -1e-18) << speed;
    EXPECT_GT(drive.work, 5e-12);
  }
}

/// The needle gives way as the zona fails: the fading force returns no more than was stored.
TEST(PuncturableCell, AFailingLayerReturnsNoMoreThanItHad) {
  for (const double speed : {1e-6, 1e-4, 1e-2}) {
    PunctureDrive drive(PunctureConfig::atForce(1e-6), 100000);
    drive.toDepth(10.001e-6);
    const double stored = drive.work;
    EXPECT_NEAR(stored, 0.5 * 1e-6 * 10e-6, 0.01e-12);
    drive.toDepth(-5e-6, speed);
    EXPECT_GE(drive.work, 0) << speed;
    EXPECT_LT(drive.work, stored);
  }
}

}  // namespace
}  // namespace microinjection
