// Converged forces against the references of test/reference/README.md, whose errors the tolerances contain.

#include "cell/model/converged_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

Scene scene(const std::string& model = "linear", double poisson = 0.49) {
  Scene result;
  result.cell.material() = {model, 17.9e3, poisson};
  return result;
}

std::vector<ForcePoint> push(const Scene& scene, const std::vector<double>& depths, double tolerance = 0.005,
                             ElementKind element = ElementKind::kP2P0) {
  Indenting indenting;
  indenting.depths = depths;
  ConvergedForceConfig config;
  config.tolerance = tolerance;
  config.element = element;
  return ConvergedForce(scene, indenting, config).solve();
}

/// N at m, relative tolerance
void expectForce(const ForcePoint& point, double force, double tolerance) {
  EXPECT_TRUE(point.converged) << point.depth << ": " << point.reason;
  EXPECT_NEAR(point.force.z() / force, 1, tolerance) << point.depth;
}

TEST(ConvergedForce, LinearDisc) {
  expectForce(push(scene("linear", 0.45), {1e-6})[0], 0.11226e-6, 0.005);
  expectForce(push(scene("linear", 0.49), {1e-6})[0], 0.11688e-6, 0.005);
  expectForce(push(scene("linear", 0.499), {1e-6})[0], 0.11811e-6, 0.005);
}

TEST(ConvergedForce, NearlyIncompressibleDoesNotLock) {
  const double nearly = push(scene("linear", 0.499), {1e-6})[0].force.z();
  EXPECT_NEAR(push(scene("linear", 0.4999), {1e-6})[0].force.z() / nearly, 1, 0.005);
  EXPECT_NEAR(push(scene("linear", 0.499999), {1e-6})[0].force.z() / nearly, 1, 0.005);
}

TEST(ConvergedForce, NeoHookeanDisc) {
  const auto points = push(scene("neo_hookean"), {1e-6, 2e-6, 5e-6, 10e-6});
  expectForce(points[0], 0.1149e-6, 0.01);
  expectForce(points[1], 0.2263e-6, 0.01);
  expectForce(points[2], 0.542e-6, 0.02);
  expectForce(points[3], 1.04e-6, 0.04);
}

TEST(ConvergedForce, StVenantKirchhoffEnds) {
  const auto points = push(scene("st_venant_kirchhoff"), {0.25e-6, 0.5e-6, 5e-6});
  expectForce(points[0], 0.0278e-6, 0.01);
  expectForce(points[1], 0.0526e-6, 0.01);
  EXPECT_FALSE(points[2].converged);
  EXPECT_NE(points[2].reason.find("stable"), std::string::npos) << points[2].reason;
  EXPECT_TRUE(std::isnan(points[2].error_estimate));
}

TEST(ConvergedForce, Layers) {
  Scene layered = scene("neo_hookean");
  layered.cell.layers = {{"zona_pellucida", 28e-6, {"neo_hookean", 17.9e3, 0.49}, 0},
                         {"cytoplasm", 24e-6, {"neo_hookean", 1e3, 0.49}, 0}};
  const auto points = push(layered, {1e-6, 5e-6, 10e-6});
  expectForce(points[0], 0.0287e-6, 0.02);
  expectForce(points[1], 0.1199e-6, 0.03);
  expectForce(points[2], 0.194e-6, 0.03);
}

TEST(ConvergedForce, LayersOfOneMaterialAreOneCell) {
  Scene layered = scene("neo_hookean");
  layered.cell.layers = {{"outer", 28e-6, {"neo_hookean", 17.9e3, 0.49}, 0},
                         {"inner", 20e-6, {"neo_hookean", 17.9e3, 0.49}, 0}};
  const double one = push(scene("neo_hookean"), {2e-6})[0].force.z();
  EXPECT_NEAR(push(layered, {2e-6})[0].force.z() / one, 1, 0.005);
}

TEST(ConvergedForce, StickingHemisphereToThePunctureDepth) {
  const auto points = push(pipetteScene("sticking"), {1e-6, 5e-6, 10e-6, 20e-6, 45e-6}, 0.02);
  expectForce(points[0], 0.0442e-6, 0.02);
  expectForce(points[1], 0.3975e-6, 0.02);
  expectForce(points[2], 0.933e-6, 0.02);
  expectForce(points[3], 2.175e-6, 0.02);
  expectForce(points[4], 8e-6, 0.05);
}

TEST(ConvergedForce, SlidingHemisphere) {
  const auto points = push(pipetteScene("sliding"), {1e-6, 2e-6, 5e-6}, 0.01);
  expectForce(points[0], 0.0441e-6, 0.015);
  expectForce(points[1], 0.1153e-6, 0.015);
  expectForce(points[2], 0.3764e-6, 0.015);
}

/// Ratios to the neo-Hookean force on one mesh by GetFEM: benchmark/peers/getfem_cell.py, P2-P1, section of level 1.
TEST(ConvergedForce, StiffeningMaterialsAreAsStiffAsInGetFEM) {
  Scene sliding = pipetteScene("sliding");
  const double neo_hookean = push(sliding, {5e-6})[0].force.z();
  sliding.cell.material().model = "ogden";
  expectForce(push(sliding, {5e-6})[0], 0.9913 * neo_hookean, 0.003);  // softer in moderate compression
  sliding.cell.material().model = "gent";
  sliding.cell.material().gent_limit = 1;
  expectForce(push(sliding, {5e-6})[0], 1.2268 * neo_hookean, 0.003);
}

TEST(ConvergedForce, MuchFrictionSticks) {
  Scene rough = pipetteScene("sliding");
  rough.needle.contact.friction = 3;
  const double stuck = push(pipetteScene("sticking"), {5e-6}, 0.02)[0].force.z();
  const double smooth = push(pipetteScene("sliding"), {5e-6}, 0.02)[0].force.z();
  EXPECT_LT(smooth, 0.97 * stuck);
  EXPECT_NEAR(push(rough, {5e-6}, 0.02)[0].force.z() / stuck, 1, 0.01);
}

/// To a quarter of the diameter, where a smooth tip has no solution any more; GetFEM's force is not known there.
TEST(ConvergedForce, FrictionLiesBetweenSlidingAndSticking) {
  const std::vector<double> depths = {5e-6, 14e-6};
  const double stuck = push(pipetteScene("sticking"), depths, 0.02)[1].force.z();
  double last = push(pipetteScene("sliding"), {5e-6}, 0.02)[0].force.z(), last_deep = 0.7 * stuck;
  for (const double friction : {0.1, 0.2, 0.5, 2.0}) {
    Scene rubbed = pipetteScene("sliding");
    rubbed.needle.contact.friction = friction;
    const auto points = push(rubbed, depths, 0.02);
    EXPECT_TRUE(points[1].converged) << friction << ": " << points[1].reason;
    EXPECT_GT(points[0].force.z(), last) << friction;
    EXPECT_GT(points[1].force.z(), last_deep) << friction;
    last = points[0].force.z();
    last_deep = points[1].force.z();
  }
  EXPECT_NEAR(last_deep / stuck, 1, 0.005);
}

TEST(ConvergedForce, ScalesWithModulusAndSize) {
  Scene small = scene("neo_hookean");
  const double force = push(small, {2e-6})[0].force.z();
  small.cell.material().young_modulus = 1e3;
  EXPECT_NEAR(push(small, {2e-6})[0].force.z() / force, 1 / 17.9, 1e-6);
  Scene large = scene("neo_hookean");
  large.cell.layers.front().outer_radius *= 20;
  large.holding_pipette.contact_radius *= 20;
  large.needle.tip.radius *= 20;
  EXPECT_NEAR(push(large, {40e-6})[0].force.z() / force, 400, 0.005 * 400);
}

TEST(ConvergedForce, InSpaceOnTheAxisItIsTheSectionsForce) {
  ConvergedForceConfig config;
  config.model = ConvergedForceConfig::Model::kSpatial;
  config.tolerance = 0.05;
  Indenting indenting;
  indenting.depths = {1e-6};
  const ForcePoint point = ConvergedForce(scene(), indenting, config).solve()[0];
  expectForce(point, 0.11688e-6, 0.02);
  EXPECT_LT(point.force.head<2>().norm(), 1e-4 * point.force.z());
}

/// The stiffness is symmetric: what a lateral motion does to the vertical force, a vertical one does to the lateral.
TEST(ConvergedForce, OffTheAxisLateralAndVerticalAnswersAreReciprocal) {
  Scene off = scene();
  off.needle.offset = {0, 10e-6};
  ConvergedForceConfig config;
  config.tolerance = 0.05;
  Indenting down;
  down.depths = {1e-6};
  const Eigen::Vector3d vertical = ConvergedForce(off, down, config).solve()[0].force;
  EXPECT_GT(vertical.y(), 0.1 * vertical.z());  // pushed off the slope
  EXPECT_LT(std::abs(vertical.x()), 1e-3 * vertical.z());
  Indenting sideways = down;
  sideways.depths = {0};
  sideways.lateral = {0, 1e-6};
  const Eigen::Vector3d lateral = ConvergedForce(off, sideways, config).solve()[0].force;
  EXPECT_LT(lateral.y(), 0);  // the cell pulls back
  EXPECT_NEAR(-lateral.z() / vertical.y(), 1, 1e-3);
}

/// How a force that goes with E / (1 - nu^2) follows from mu alone being larger, lambda being what it was.
double stiffening(double factor) {
  const double poisson = 0.49, lambda = 2 * poisson / (1 - 2 * poisson);  // in units of mu
  const auto plane = [&](double mu) {
    const double nu = lambda / (2 * (lambda + mu));
    return mu * (3 * lambda + 2 * mu) / (lambda + mu) / (1 - nu * nu);
  };
  return plane(factor) / plane(1);
}

TEST(ConvergedForce, RelaxesAndDependsOnSpeed) {
  Scene slow = scene("neo_hookean");
  slow.cell.material().viscoelasticity.prony = {{0.8, 0.5}};
  Indenting indenting;
  indenting.depths = {2e-6};
  ConvergedForceConfig config;
  config.tolerance = 0.02;
  const double relaxed = ConvergedForce(slow, indenting, config).solve()[0].force.z();
  EXPECT_NEAR(relaxed / push(scene("neo_hookean"), {2e-6}, 0.02)[0].force.z(), 1, 1e-6);
  indenting.speed = 1;  // m/s: in 2 us
  const double fast = ConvergedForce(slow, indenting, config).solve()[0].force.z();
  EXPECT_NEAR(fast / relaxed, stiffening(1.8), 0.01);
  indenting.hold = 0.5;
  const double held = ConvergedForce(slow, indenting, config).solve()[0].force.z();
  EXPECT_NEAR(held / relaxed, stiffening(1 + 0.8 * std::exp(-1)), 0.01);
}

TEST(ConvergedForce, RefusesANeedleThatIsTooFarOut) {
  Scene off = scene();
  off.needle.offset = {0.84 * off.radius(), 0};
  try {
    ConvergedForce(off, {{1e-6}}, {}).solve();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("needle/offset"), std::string::npos) << error.what();
  }
}

TEST(ConvergedForce, RefusesASectionThatIsNone) {
  ConvergedForceConfig config;
  config.model = ConvergedForceConfig::Model::kAxisymmetric;
  Scene off = scene();
  off.needle.offset = {1e-6, 0};
  EXPECT_THROW(ConvergedForce(off, {}, config), ConfigError);
}

}  // namespace
}  // namespace microinjection
