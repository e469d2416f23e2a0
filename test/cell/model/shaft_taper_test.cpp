#include "cell/model/shaft_taper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/errors.h"
#include "cell/model/solved_branch.h"

namespace microinjection {
namespace {

/// A cell of 80 um under a tip of 3 um whose shaft widens.
Scene sceneWith(double taper) {
  Scene scene;
  scene.cell.layers[0].outer_radius = 40e-6;
  scene.cell.material().model = "neo_hookean";
  scene.cell.material().young_modulus = 2.9994e3;
  scene.cell.material().poisson_ratio = 0.4997;
  scene.needle.tip = {"hemisphere", 3e-6, 0, taper};
  scene.cell.puncture.layers.emplace_back().toughness = 3e-3;  // J / (mu R) = 1
  return scene;
}

/// Of an incompressible block E(b, r) = pi mu (r^2 - b^2) ln(r / b); here the solid ends at 40 um.
TEST(ShaftTaper, FeelsWhatOpensTheHoleFurther) {
  const double slope = 0.1;
  const Scene scene = sceneWith(std::atan(slope));
  const double hole = 3e-6 * steadyPenetration(scene).hole_radius;
  const ShaftTaper taper(scene, hole, 4e-6);
  const auto energy = [&](double radius) {
    const double opened = radius * radius - hole * hole;
    const double outside = std::log(std::sqrt(1 + opened / (40e-6 * 40e-6)));
    return M_PI * 1e3 * opened * (std::log(radius / hole) - outside);
  };
  EXPECT_EQ(taper.force(0), 0);
  EXPECT_EQ(taper.force(4e-6), 0) << "of the dent nothing is opened";
  for (const double length : {5e-6, 20e-6, 35e-6}) {
    const double expected = energy(3e-6 + slope * length) - energy(3e-6);
    EXPECT_NEAR(taper.force(4e-6 + length), expected, 0.02 * expected) << length;
  }
}

TEST(ShaftTaper, RefusesAShaftThatTheMaterialCannotBeStretchedAround) {
  Scene scene = sceneWith(0.1);
  scene.cell.material().model = "gent";
  scene.cell.material().gent_limit = 10;
  try {
    ShaftTaper(scene, 1.1e-6, 4e-6);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("needle/tip/taper = 0.1 rad"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace microinjection
