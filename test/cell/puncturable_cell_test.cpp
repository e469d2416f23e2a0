#include "cell/puncturable_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cell/cell_model.h"
#include "cell/cell_tracker.h"
#include "cell/spring_cell.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6, kTop = kRadius, kStiffness = 0.1;  // m, m, N/m
constexpr double kFriction = 0.05e-6;                                // N
const Eigen::Vector3d kAxis = Eigen::Vector3d::UnitZ();

Scene sceneOf(const PunctureConfig& puncture) {
  Scene scene;
  scene.cell.puncture = puncture;
  return scene;
}

/// Zona at 1 uN, that is 10 um deep; oolemma 2 um further of 0.02 N/m, at 0.2 uN, that is after 10 um more.
PunctureConfig oocyte() {
  PunctureConfig config = PunctureConfig::atForce(1e-6);
  PunctureConfig::Layer& oolemma = config.layers.emplace_back();
  oolemma.name = "oolemma";
  oolemma.force = 0.2e-6;
  oolemma.stiffness = 0.02;
  oolemma.gap = 2e-6;
  config.shaft.friction = kFriction;
  return config;
}

class Drive {
 public:
  explicit Drive(const PunctureConfig& puncture, double rate = 1000) : step_(1 / rate) {
    auto inner = std::make_unique<SpringCell>(kRadius, kStiffness);
    spring = inner.get();
    cell = std::make_unique<PuncturableCell>(sceneOf(puncture), std::move(inner));
  }

  /// On a straight line at `speed`, m/s; returns the force's z at the end, N.
  double moveTo(const Eigen::Vector3d& goal, double speed = 20e-6) {
    const int steps = std::max(1, static_cast<int>(std::lround((goal - tip).norm() / (speed * step_))));
    const Eigen::Vector3d start = tip;
    for (int i = 1; i <= steps; ++i) {
      const Eigen::Vector3d last = tip;
      const Eigen::Vector3d last_force = force;
      tip = start + (goal - start) * i / steps;
      time += step_;
      force = cell->step(tip, kAxis, time).force;
      work -= 0.5 * (last_force + force).dot(tip - last);
      least_work = std::min(least_work, work);
      largest = std::max(largest, force.z());
      smallest = std::min(smallest, force.z());
    }
    return force.z();
  }
  double toDepth(double depth, double speed = 20e-6) { return moveTo({tip.x(), tip.y(), kTop - depth}, speed); }
  double rest(double duration) {
    for (int i = 0; i < std::lround(duration / step_); ++i) {
      time += step_;
      force = cell->step(tip, kAxis, time).force;
    }
    return force.z();
  }
  int layers() const { return cell->insertion().layers_punctured; }

  std::unique_ptr<PuncturableCell> cell;
  SpringCell* spring;
  Eigen::Vector3d tip{0, 0, kTop + 5e-6};
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double time = 0;
  double work = 0, least_work = 0;   ///< J, of the needle on the cell
  double largest = 0, smallest = 0;  ///< N along the pipette

 private:
  double step_;
};

TEST(PuncturableCell, IsTheInnerCellUntilALayerFails) {
  Drive drive({}), whole(PunctureConfig::atForce(1e-6));
  EXPECT_NEAR(drive.toDepth(30e-6), kStiffness * 30e-6, 1e-15);  // nothing to puncture
  EXPECT_FALSE(drive.cell->insertion().punctured);
  EXPECT_NEAR(whole.toDepth(9.9e-6), kStiffness * 9.9e-6, 1e-15);
  EXPECT_FALSE(whole.cell->insertion().inside);
  EXPECT_EQ(whole.layers(), 0);
  EXPECT_EQ(whole.cell->insertion().depth, 0);
  EXPECT_TRUE(whole.cell->picture().holes.empty());
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
    Drive drive(config);
    drive.toDepth(7.99e-6);
    EXPECT_EQ(drive.layers(), 0);
    drive.toDepth(8.03e-6);
    EXPECT_EQ(drive.layers(), 1);
    EXPECT_TRUE(drive.cell->insertion().inside);
    EXPECT_NEAR(drive.cell->insertion().depth, 8.03e-6, 1e-12);
    EXPECT_EQ(drive.spring->released, 1);
    EXPECT_NEAR(drive.largest, 0.8e-6, 0.003e-6);
    ASSERT_EQ(drive.cell->picture().holes.size(), 1u);
    EXPECT_TRUE(drive.cell->picture().holes[0].isApprox(Eigen::Vector3d(0, 0, kTop)));
  }
}

/// A live cell in lock step: whole to the stated force, at rest after it, and touched again elsewhere.
TEST(PuncturableCell, ServesALiveCell) {
  Scene scene = sceneOf(PunctureConfig::atForce(0.5e-6));
  scene.cell.material() = {"linear", 17.9e3, 0.45};
  scene.mesh.size = 20e-6;
  CellTrackerConfig config;
  config.fixed_period = true;
  PuncturableCell cell(scene, std::make_unique<CellTracker>(std::make_shared<const CellModel>(scene), config));
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
  const CellUnderNeedle::Picture picture = cell.picture();
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
  Drive drive(config);
  drive.spring->trusted = false;
  drive.toDepth(15e-6);
  EXPECT_EQ(drive.layers(), 0);
  EXPECT_FALSE(drive.cell->step(drive.tip, kAxis, drive.time + 1e-3).trusted);
}

/// The tip rests where the zona fails: the force falls to 1/e in the relaxation time, and to exactly nothing.
TEST(PuncturableCell, TheForceFallsInTheRelaxationTime) {
  Drive drive(PunctureConfig::atForce(1e-6), 10000);
  drive.toDepth(10e-6 + 1e-12);
  EXPECT_DOUBLE_EQ(drive.force.z(), 1e-6);
  EXPECT_NEAR(drive.rest(2e-3), std::exp(-1) * 1e-6, 1e-12);
  EXPECT_EQ(drive.rest(50e-3), 0);
}

TEST(PuncturableCell, LayerAfterLayer) {
  Drive drive(oocyte());
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
    Drive drive(config);
    drive.toDepth(19.98e-6);  // 10 um zona, 2 um gap, 8 um
    EXPECT_EQ(drive.layers(), 1);
    drive.toDepth(20.06e-6);
    EXPECT_EQ(drive.layers(), 2);
  }
}

/// The hole stays: within a tip's radius there is no zona, elsewhere there is.
TEST(PuncturableCell, RemembersItsHoles) {
  Drive drive(oocyte());
  drive.toDepth(15e-6);  // zona only
  drive.toDepth(-5e-6);
  drive.largest = 0;
  drive.moveTo({2e-6, 0, kTop + 5e-6});
  EXPECT_NEAR(drive.toDepth(1.8e-6), kFriction, 1e-12);  // at rest the oolemma is 2 um below the zona
  EXPECT_EQ(drive.layers(), 1);
  EXPECT_NEAR(drive.toDepth(7e-6), kFriction + 0.02 * 5e-6, 1e-12);
  drive.toDepth(12.1e-6);
  EXPECT_EQ(drive.layers(), 2);
  EXPECT_LT(drive.largest, 0.3e-6);
  drive.toDepth(-5e-6);
  drive.toDepth(15e-6);  // nothing left
  EXPECT_NEAR(drive.force.z(), kFriction, 1e-12);
  EXPECT_EQ(drive.layers(), 2);
  drive.toDepth(-5e-6);
  drive.moveTo({-4e-6, 0, kTop + 5e-6});
  drive.toDepth(9e-6);
  EXPECT_GT(drive.force.z(), 0.8e-6);
  EXPECT_EQ(drive.cell->picture().holes.size(), 1u);
  drive.toDepth(12e-6);
  EXPECT_EQ(drive.layers(), 1);
  EXPECT_EQ(drive.cell->picture().holes.size(), 2u);
}

/// However often: the oldest of very many holes are forgotten, the newest never.
TEST(PuncturableCell, ManyHolesAreBounded) {
  PunctureConfig config = PunctureConfig::atForce(0.1e-6);
  Scene scene = sceneOf(config);
  scene.needle.tip.radius = 0.1e-6;
  PuncturableCell cell(scene, std::make_unique<SpringCell>(kRadius, kStiffness));
  double time = 0;
  const auto punch = [&](double x) {
    double largest = 0;
    for (int i = 0; i < 200; ++i) {
      const double height = kTop + 0.1e-6 * (i < 100 ? -i : i - 200);
      largest = std::max(largest, cell.step({x, 0, height}, kAxis, time += 0.1).force.z());
    }
    return largest;
  };
  for (int i = 0; i < 70; ++i) EXPECT_GT(punch(0.3e-6 * (i - 35)), 0.09e-6);
  EXPECT_EQ(cell.picture().holes.size(), static_cast<std::size_t>(PunctureHoles::kMost));
  EXPECT_EQ(punch(0.3e-6 * 34), 0);
  EXPECT_GT(punch(0.3e-6 * -35), 0.09e-6);
}

/// Over a slope the tip is in an old hole as soon as it is in the cell, on the uphill side as well: a way out sideways
/// from just there meets no cell that is dented already.
TEST(PuncturableCell, SidewaysOutOfAHoleIsNoKick) {
  PunctureConfig config = PunctureConfig::atForce(0.5e-6);
  config.shaft.lateral_stiffness = 0.01;
  Drive drive(config);
  drive.moveTo({20e-6, 0, kTop});
  drive.moveTo({20e-6, 0, 10e-6});
  ASSERT_EQ(drive.layers(), 1);
  drive.moveTo({20e-6, 0, kTop});
  drive.rest(0.1);
  drive.largest = 0;
  Eigen::Vector3d last = drive.force;
  double jump = 0;
  drive.moveTo({17.5e-6, 0, kTop});
  const std::vector<Eigen::Vector3d> way = {{17.5e-6, 0, 21.7e-6}, {14e-6, 0, 21.7e-6}, {14e-6, 0, 26e-6}};
  for (const Eigen::Vector3d& goal : way) {
    for (int i = 0; i < 1000; ++i) {
      drive.moveTo(drive.tip + (goal - drive.tip) / (1000 - i), 1);
      jump = std::max(jump, (drive.force - last).norm());
      last = drive.force;
    }
  }
  EXPECT_LT(jump, 0.4 * 0.01 * 3.5e-6);  // what fades in a step of the sideways force at the exit
  EXPECT_FALSE(drive.cell->insertion().inside);
  EXPECT_EQ(drive.rest(0.05), 0);
}

/// Beside the cell the needle is out, wherever it came in.
TEST(PuncturableCell, LateralExitLeavesTheCell) {
  PunctureConfig config = oocyte();
  config.shaft.lateral_stiffness = 0.01;
  Drive drive(config);
  drive.toDepth(25e-6);
  drive.moveTo({10e-6, 0, kTop - 25e-6});
  EXPECT_NEAR(drive.force.x(), -0.01 * 10e-6, 1e-15);
  EXPECT_TRUE(drive.cell->insertion().inside);
  drive.moveTo({30e-6, 0, kTop - 25e-6});
  EXPECT_FALSE(drive.cell->insertion().inside);
  EXPECT_TRUE(drive.rest(0.1) == 0 && drive.force.isZero(0));
  EXPECT_GE(drive.least_work, 0);
}

TEST(PuncturableCell, APoseThatIsNotFiniteChangesNothing) {
  Drive drive(oocyte()), same(oocyte());
  for (Drive* each : {&drive, &same}) each->toDepth(14e-6);
  const TipForce bad = drive.cell->step({0, NAN, 0}, kAxis, drive.time);
  EXPECT_FALSE(bad.trusted);
  EXPECT_TRUE(bad.force.isZero(0));
  EXPECT_NE(drive.cell->distrust(), "");
  EXPECT_FALSE(drive.cell->step(drive.tip, kAxis, NAN).trusted);
  EXPECT_EQ(drive.toDepth(13e-6), same.toDepth(13e-6));
  EXPECT_EQ(drive.cell->distrust(), "");
}

TEST(PuncturableCell, SamePathSameBitsAndNearlySameAtAnyRate) {
  PunctureConfig config = oocyte();
  config.shaft = {kFriction, 1e-3, 0.3, 5, 0.01};
  Drive slow(config), again(config), fast(config, 10000);
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
    Drive drive(config);
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
    Drive drive(PunctureConfig::atForce(1e-6), 100000);
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
