#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "cell/model/puncturable_cell.h"
#include "cell/surrogate/spring_cells.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

Scene punctured(double factor) {
  Scene scene = pipette();
  scene.cell.material().young_modulus *= factor;
  PunctureConfig::Layer zona, oolemma;
  zona.force = 1e-6;
  oolemma.force = 0.15e-6;
  oolemma.gap = 1e-6;
  oolemma.stiffness = 0.05;
  scene.cell.puncture.layers = {zona, oolemma};
  scene.cell.puncture.shaft.friction = 0.2e-6;
  return scene;
}

/// A cell whose modulus changes by a factor of three and back twenty times a second, while a needle goes through its
/// membranes and out again.
TEST(ChangingPuncture, IsPassiveAndItsForceIsBounded) {
  const std::vector<Scene> scenes = {punctured(1), punctured(3)};
  std::vector<std::shared_ptr<const SurrogateData>> data;
  for (const Scene& scene : scenes) data.push_back(fieldOfSprings(scene, 0.3));
  for (int phase = 0; phase < 50; phase += 7) {
    auto tracker = std::make_unique<SurrogateCellModel>(scenes[0], data[0]);
    SurrogateCellModel& changing = *tracker;
    PuncturableCell cell(scenes[0], std::move(tracker));
    Eigen::Vector3d tip(0, 0, 34e-6), force = Eigen::Vector3d::Zero();
    double work = 0, all = 0, largest = 0, time = 0;
    int steps = phase;
    const auto go = [&](double height) {
      const int count = static_cast<int>(std::abs(height - tip.z()) / 0.01e-6);
      const Eigen::Vector3d move(0, 0, (height - tip.z()) / count);
      for (int i = 0; i < count; ++i) {
        if (++steps % 50 == 0) {
          const std::size_t next = (steps / 50) % 2;
          changing.change(scenes[next], data[next]);
        }
        tip += move;
        const TipForce now = cell.step(tip, kUp, time += kPeriod);
        ASSERT_TRUE(now.valid) << cell.invalidReason();
        work += 0.5 * (force + now.force).dot(move);
        all += std::abs(0.5 * (force + now.force).dot(move));
        largest = std::max(largest, now.force.norm());
        force = now.force;
      }
    };
    go(4e-6);
    EXPECT_EQ(cell.insertion().layers_punctured, 2);
    go(40e-6);
    EXPECT_LT(work, 1e-3 * all);
    EXPECT_LT(largest, 1.3e-6);  // the zona's force and the shaft's friction
    EXPECT_GT(largest, 0.5e-6);
    EXPECT_FALSE(cell.insertion().inside);
  }
}

TEST(ChangingPuncture, HolesMoveWithTheSurfaceOfAGrownCell) {
  const Scene scene = punctured(3);
  Scene larger = scene;
  larger.cell.layers.front().outer_radius *= 1.1;
  auto tracker = std::make_unique<SurrogateCellModel>(scene, fieldOfSprings(scene, 0));
  SurrogateCellModel& changing = *tracker;
  PuncturableCell cell(scene, std::move(tracker));
  double time = 0;
  const auto go = [&](double from, double to) {
    for (int i = 0; i <= 2000; ++i) cell.step({0, 0, from + (to - from) * i / 2000}, kUp, time += kPeriod);
  };
  go(34e-6, 4e-6);
  go(4e-6, 40e-6);
  ASSERT_EQ(cell.deformedSurface().holes.size(), 1u);
  const double before = cell.deformedSurface().holes[0].z();
  changing.change(larger, fieldOfSprings(larger, 0));
  for (int i = 0; i < 100; ++i) cell.step({20e-6, 0, 45e-6}, kUp, time += kPeriod);
  EXPECT_NEAR(cell.deformedSurface().holes[0].z(), 1.1 * before, 1e-12);
  // In through the hole, without another puncture.
  for (int i = 0; i <= 2000; ++i) {
    const TipForce force = cell.step({0, 0, 40e-6 - 25e-6 * i / 2000}, kUp, time += kPeriod);
    EXPECT_LT(force.force.norm(), 0.3e-6);
  }
  EXPECT_EQ(cell.deformedSurface().holes.size(), 1u);
}

}  // namespace
}  // namespace microinjection
