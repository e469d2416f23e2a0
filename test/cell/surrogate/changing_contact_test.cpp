#include "cell/surrogate/changing_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>

#include "cell/surrogate/allocation_count.h"
#include "cell/surrogate/spring_cells.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

Scene stiffer(double factor) {
  Scene scene = pipette();
  scene.cell.material().young_modulus *= factor;
  return scene;
}

Scene larger(double factor) {
  Scene scene = pipette();
  scene.cell.layers.front().outer_radius *= factor;
  return scene;
}

/// A cell pressed 6 um deep at one second.
struct Pressed {
  SurrogateCellModel cell{pipette(), fieldOfSprings(pipette(), 0.3)};
  double time = 0;
  TipForce force;

  Pressed() {
    for (double depth = -1e-6; depth < 6e-6; depth += 0.02e-6) step(28e-6 - depth);
    step(22e-6);
  }
  void step(double height) { force = cell.step({0, 0, height}, kUp, time += kPeriod); }
  void change(const Scene& scene) { cell.change(scene, fieldOfSprings(scene, 0.3)); }
};

TEST(ChangingContact, AStifferCellIsFeltUnderARestingNeedleWithoutAStep) {
  Pressed pressed;
  const double before = pressed.force.force.z();
  ASSERT_GT(before, 0);
  pressed.change(stiffer(3));
  double largest_step = 0;
  for (int i = 0; i < 60; ++i) {
    const double last = pressed.force.force.z();
    pressed.step(22e-6);
    EXPECT_TRUE(pressed.force.valid);
    largest_step = std::max(largest_step, std::abs(pressed.force.force.z() - last));
  }
  EXPECT_NEAR(pressed.force.force.z(), 3 * before, 0.02 * before);
  EXPECT_LT(largest_step, 1.1 * 2 * before * kPeriod / ChangingContact::kDuration);
}

TEST(ChangingContact, TheFeltSceneIsReported) {
  Pressed pressed;
  pressed.change(stiffer(3));
  for (int i = 0; i < 60; ++i) pressed.step(22e-6);
  const auto surface = pressed.cell.deformedSurface();
  ASSERT_TRUE(surface.scene);
  EXPECT_EQ(surface.scene->cell.material().young_modulus, 3 * pipette().cell.material().young_modulus);
  ASSERT_EQ(surface.at_rest.size(), surface.vertices.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    EXPECT_NEAR((surface.vertices[i] - surface.at_rest[i]).norm(), surface.displacement[i], 1e-12);
}

/// Otherwise a better measured diameter would push the needle out.
TEST(ChangingContact, ACellOfAnotherSizeKeepsItsSurfaceUnderTheNeedle) {
  for (const double factor : {0.8, 1.3}) {
    Pressed pressed;
    const auto contact = pressed.cell.contact()->contact_point;
    pressed.change(larger(factor));
    for (int i = 0; i < 60; ++i) pressed.step(22e-6);
    ASSERT_TRUE(pressed.cell.contact()) << factor;
    EXPECT_EQ(pressed.cell.contact()->contact_point, contact) << factor;
    // Clear of both cells, the next contact is where the new one is.
    pressed.step(60e-6);
    double touched = 0;
    for (double height = 60e-6; touched == 0 && height > 0; height -= 0.02e-6) {
      pressed.step(height);
      if (pressed.cell.contact()) touched = height;
    }
    EXPECT_NEAR(touched, factor * 28e-6, 0.1e-6) << factor;
  }
}

TEST(ChangingContact, BesideAGrownCellTheNeedleIsNotPushed) {
  Pressed pressed;
  for (double height = 22e-6; height < 29e-6; height += 0.02e-6) pressed.step(height);
  ASSERT_FALSE(pressed.cell.contact());
  pressed.change(larger(1.3));  // to a radius of 36 um, around the tip
  for (int i = 0; i < 60; ++i) {
    pressed.step(29e-6);
    EXPECT_TRUE(pressed.force.force.isZero(0));
  }
}

/// The springs of three moduli and two sizes, exchanged at random twenty times a second.
TEST(ChangingContact, ClosedPathsCreateNoEnergyWhileTheCellChanges) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Scene> scenes = {pipette(), stiffer(3), stiffer(1.0 / 3), larger(1.1), larger(0.9)};
  std::vector<std::shared_ptr<const SurrogateData>> data;
  for (const Scene& scene : scenes) data.push_back(fieldOfSprings(scene, 0.3));
  for (int seed = 0; seed < 10; ++seed) {
    SurrogateCellModel cell(scenes[0], data[0]);
    Eigen::Vector3d tip(0, 0, 34e-6), force = Eigen::Vector3d::Zero();
    double work = 0, all = 0, time = 0;
    int steps = 0;
    const auto go = [&](const Eigen::Vector3d& target) {
      const int count = 400;
      const Eigen::Vector3d move = (target - tip) / count;
      for (int i = 0; i < count; ++i) {
        if (++steps % 50 == 0) {
          const auto next = static_cast<std::size_t>(2.5 * (1 + share(random)));
          cell.change(scenes[next], data[next]);
        }
        tip += move;
        const TipForce now = cell.step(tip, kUp, time += kPeriod);
        work += 0.5 * (force + now.force).dot(move);
        all += std::abs(0.5 * (force + now.force).dot(move));
        force = now.force;
      }
    };
    for (int leg = 0; leg < 8; ++leg) {
      go({6e-6 * share(random), 6e-6 * share(random), 20e-6 + 9e-6 * share(random)});
      if (leg % 3 == 2) go({0, 0, 40e-6});
    }
    go({0, 0, 40e-6});
    EXPECT_LT(work, 2e-3 * all) << seed;
    EXPECT_GT(all, 0);
  }
}

TEST(ChangingContact, AStepThatTakesACellOverAllocatesNothing) {
  Pressed pressed;
  std::size_t allocated = 0;
  for (int n = 0; n < 20; ++n) {
    pressed.change(stiffer(n % 2 == 0 ? 3 : 1));
    const std::size_t before = allocationCount();
    for (int i = 0; i < 30; ++i) pressed.step(22e-6);
    allocated += allocationCount() - before;
  }
  EXPECT_EQ(allocated, 0u);
}

TEST(ChangingContact, TheLastOfQuickChangesIsServed) {
  Pressed pressed;
  const double before = pressed.force.force.z();
  for (int n = 0; n < 20; ++n) pressed.change(stiffer(1 + 0.05 * n));
  pressed.change(stiffer(2));
  for (int i = 0; i < 60; ++i) pressed.step(22e-6);
  EXPECT_NEAR(pressed.force.force.z(), 2 * before, 0.02 * before);
}

}  // namespace
}  // namespace microinjection
