#include "surrogate/prepared_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/errors.h"
#include "surrogate/prepared_tracker.h"

namespace microinjection {
namespace {

Scene pipette() {
  Scene scene;
  scene.needle.tip.shape = "hemisphere";
  return scene;
}

/// A cell with an energy of t^2 alone: isotropic springs in the scaled coordinates.
std::shared_ptr<PreparedCell> springs(const Scene& scene) {
  auto cell = std::make_shared<PreparedCell>();
  cell->range = PreparationRange::standard(scene);
  const Preparation plan = Preparation::plan(scene, cell->range);
  cell->energy = EnergyExpansion(plan.scales, plan.degrees);
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(cell->energy.size());
  coefficients[0] = 1;
  cell->energy.setCoefficients(coefficients);
  return cell;
}

TEST(ContactPlace, IsWhereTheTipMeetsTheCell) {
  const Scene scene = pipette();
  for (double angle : {0.0, 0.3, 1.0}) {
    const Eigen::Vector2d offset = ContactPlace::offsetFor(scene, angle);
    const auto place = ContactPlace::at(scene, offset);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->angle, angle, 1e-9);
    const Eigen::Vector3d centre = place->origin + Eigen::Vector3d(0, 0, scene.needle.tip.radius);
    EXPECT_NEAR(centre.norm(), scene.radius() + scene.needle.tip.radius, 1e-12);
  }
  const auto beside = ContactPlace::at(scene, {0, 10e-6});
  EXPECT_NEAR(beside->rotation(1, 0), 1, 1e-12);  // x of the place is y of the world
  EXPECT_FALSE(ContactPlace::at(scene, {32e-6, 0}));
  Scene disc;
  EXPECT_NEAR(ContactPlace::at(disc, ContactPlace::offsetFor(disc, 0.4))->angle, 0.4, 1e-12);
}

TEST(PreparedContact, TouchesFollowsAndLoses) {
  const Scene scene = pipette();
  PreparedContact contact(scene, springs(scene));
  EXPECT_TRUE(contact.step({0, 0, 28.1e-6}).force.isZero(0));
  EXPECT_FALSE(contact.place());
  const auto touched = contact.step({0, 0, 27e-6});
  ASSERT_TRUE(contact.place());
  EXPECT_GT(touched.force.z(), 0);
  EXPECT_TRUE(touched.prepared);
  const auto aside = contact.step({1e-6, 2e-6, 26e-6});
  EXPECT_LT(aside.force.x(), 0);  // the cell pulls back
  EXPECT_NEAR(aside.force.y() / aside.force.x(), 2, 1e-9);
  EXPECT_NEAR(contact.displacement().z(), -2e-6, 1e-15);
  contact.step({1e-6, 2e-6, 28.2e-6});
  EXPECT_FALSE(contact.place());
}

/// Beside the axis the same happens in a turned frame.
TEST(PreparedContact, TurnsWithThePlace) {
  const Scene scene = pipette();
  PreparedContact contact(scene, springs(scene)), turned(scene, springs(scene));
  const double height = ContactPlace::at(scene, {12e-6, 0})->origin.z();
  contact.step({12e-6, 0, height - 1e-9});
  turned.step({0, 12e-6, height - 1e-9});
  const Eigen::Vector3d a = contact.step({11e-6, 2e-6, height - 3e-6}).force;
  const Eigen::Vector3d b = turned.step({-2e-6, 11e-6, height - 3e-6}).force;
  EXPECT_LT((Eigen::Vector3d(-a.y(), a.x(), a.z()) - b).norm(), 1e-12 * a.norm());
}

TEST(PreparedContact, OutOfItsRangeItIsBoundedContinuousAndSaysSo) {
  const Scene scene = pipette();
  const auto cell = springs(scene);
  PreparedContact contact(scene, cell);
  contact.step({0, 0, 27.9e-6});
  const double border = 28e-6 - cell->range.depth;
  const auto inside = contact.step({0, 0, border + 1e-10}), outside = contact.step({0, 0, border - 1e-10});
  EXPECT_TRUE(inside.prepared);
  EXPECT_FALSE(outside.prepared);
  EXPECT_NEAR(outside.force.z() / inside.force.z(), 1, 1e-4);
  EXPECT_NEAR(contact.step({0, 0, border - 15e-6}).force.z() / inside.force.z(), 1, 1e-4);
  const double side = cell->range.lateral;
  const auto at = contact.step({0, side + 1e-10, 20e-6}), far = contact.step({0, 3 * side, 20e-6});
  EXPECT_FALSE(far.prepared);
  EXPECT_LT((at.force - far.force).norm(), 1e-3 * at.force.norm());
}

TEST(PreparedCell, IsKnownByItsScene) {
  const Scene scene = pipette();
  const PreparationRange range = PreparationRange::standard(scene);
  Scene other = scene, same = scene;
  other.cell.material().poisson_ratio = 0.48;
  same.needle.offset = {5e-6, 0};
  same.mesh.size = 5e-6;
  const auto line = [&](const Scene& s) { return Preparation::plan(s, range).description(s); };
  EXPECT_EQ(line(scene), line(same));
  EXPECT_NE(line(scene), line(other));
  PreparationRange less = range;
  less.depth /= 2;
  EXPECT_NE(line(scene), Preparation::plan(scene, less).description(scene));
}

TEST(Preparation, RefusesWhatHasNoEnergy) {
  Scene scene = pipette();
  EXPECT_NO_THROW(Preparation::check(scene));
  Scene viscous = scene, rubbing = scene;
  viscous.cell.material().viscoelasticity.viscosity = 1;
  rubbing.needle.contact = {"sliding", 0.2};
  EXPECT_THROW(Preparation::check(viscous), ConfigError);
  EXPECT_THROW(Preparation::check(rubbing), ConfigError);
}

TEST(Preparation, RaysFillTheRange) {
  const Scene scene = pipette();
  const PreparationRange range = PreparationRange::standard(scene);
  const Preparation plan = Preparation::plan(scene, range);
  for (const TrainingRay& ray : plan.rays) {
    const double lateral = ray.target.head<2>().norm() / range.lateral, depth = -ray.target.z() / range.depth;
    EXPECT_NEAR(std::max(lateral, depth), 1, 1e-12);
    EXPECT_GE(ray.target.y(), -1e-18);  // the other half is its mirror image
    EXPECT_LE(ray.angle, range.angle);
  }
}

TEST(PreparedTracker, TrustsOnlyWhatWasPreparedAndPunctures) {
  Scene scene = pipette();
  const auto cell = springs(scene);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), deep(0, 0, 20e-6);
  PreparedTracker tracker(scene, cell);
  EXPECT_TRUE(tracker.step({0, 0, 30e-6}, up, 0).trusted);
  EXPECT_FALSE(tracker.contact());
  const TipForce force = tracker.step(deep, up, 1e-3);
  EXPECT_TRUE(force.trusted);
  EXPECT_NEAR(tracker.contact()->indentation, 8e-6, 1e-15);
  EXPECT_NEAR(tracker.solution(0)->stiffness(2, 2) * 8e-6, force.force.z(), 1e-6 * force.force.z());  // a spring
  EXPECT_FALSE(tracker.step(deep, Eigen::Vector3d(0.2, 0, 1).normalized(), 2e-3).trusted);
  EXPECT_NE(tracker.distrust(), "");
  EXPECT_FALSE(tracker.step({0, 0, -10e-6}, up, 3e-3).trusted);
  EXPECT_TRUE(tracker.step(deep, up, 4e-3).trusted);
  EXPECT_EQ(tracker.distrust(), "");

  scene.cell.puncture_force = 0.5 * force.force.z();
  PreparedTracker weak(scene, cell);
  EXPECT_GT(weak.step({0, 0, 27e-6}, up, 0).force.z(), 0);
  EXPECT_TRUE(weak.step(deep, up, 1e-3).force.isZero(0));
  EXPECT_TRUE(weak.punctured());
  EXPECT_FALSE(weak.contact());
  EXPECT_TRUE(weak.step(deep, up, 2e-3).force.isZero(0));
}

}  // namespace
}  // namespace microinjection
