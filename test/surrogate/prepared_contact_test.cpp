#include "surrogate/prepared_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/errors.h"
#include "surrogate/allocation_count.h"
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

/// The same with a force field that differs from the energy's: more sideways by `more`, and so no gradient.
std::shared_ptr<PreparedCell> fieldOfSprings(const Scene& scene, double more) {
  auto cell = springs(scene);
  const Preparation plan = Preparation::plan(scene, cell->range);
  std::vector<TrainingSample> samples;
  for (double angle : {0.0, 0.3, 0.6, 0.9}) {
    EnergyExpansion::Local local;
    cell->energy.makeLocal(angle, local);
    for (int i = 1; i <= 8; ++i) {
      for (double tilt : {0.0, 0.3, 0.6, 0.9, 1.2}) {
        for (double turn : {0.0, 0.8, 1.6, 2.4, 3.1}) {
          const Eigen::Vector3d way(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
          const Eigen::Vector3d u = 0.3e-6 * i * i * way;
          Eigen::Vector3d force = -local.evaluate(u).gradient;
          force.head<2>() *= 1 + more * way.z() * way.z();
          samples.push_back({angle, u, force, {}});
        }
      }
    }
  }
  cell->field = ForceField(plan.scales);
  cell->field.fit(samples);
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

TEST(PreparedContact, OutOfItsRangeItIsContinuousFadesAndSaysSo) {
  const Scene scene = pipette();
  const auto cell = springs(scene);
  for (const double offset : {0.0, 12e-6}) {  // on the axis the range is deeper
    PreparedContact contact(scene, cell);
    const double top = ContactPlace::at(scene, {offset, 0})->origin.z();
    const double border = top - (offset == 0 ? cell->range.axis_depth : cell->range.depth);
    contact.step({offset, 0, top - 1e-8});
    const auto inside = contact.step({offset, 0, border + 1e-10}), outside = contact.step({offset, 0, border - 1e-10});
    EXPECT_TRUE(inside.prepared);
    EXPECT_FALSE(outside.prepared);
    EXPECT_NEAR(outside.force.z() / inside.force.z(), 1, 1e-3);
    EXPECT_LT(contact.step({offset, 0, border - 10e-6}).force.norm(), 0.2 * inside.force.norm());
  }
  PreparedContact contact(scene, cell);
  contact.step({12e-6, 0, 25e-6});
  const double side = cell->range.lateral;
  const auto at = contact.step({12e-6, side - 1e-10, 20e-6}), over = contact.step({12e-6, side + 1e-10, 20e-6});
  EXPECT_TRUE(at.prepared);
  EXPECT_FALSE(over.prepared);
  EXPECT_LT((at.force - over.force).norm(), 1e-3 * at.force.norm());
}

/// Straight in from the touch the force is the field's, although that is no gradient.
TEST(PreparedContact, FollowsTheFieldOnStraightPaths) {
  const Scene scene = pipette();
  const auto cell = fieldOfSprings(scene, 0.05);
  ForceField::Local local;
  for (const double offset : {0.0, 12e-6}) {
    const Eigen::Vector3d touch = ContactPlace::at(scene, {offset, 0})->origin;
    cell->field.makeLocal(ContactPlace::at(scene, {offset, 0})->angle, local);
    for (const Eigen::Vector3d& target : {Eigen::Vector3d(2e-6, 3e-6, -12e-6), Eigen::Vector3d(-4e-6, 0, -3e-6)}) {
      PreparedContact contact(scene, cell);
      contact.step(touch - Eigen::Vector3d(0, 0, 1e-12));
      Eigen::Matrix3d jacobian;
      for (int i = 1; i <= 100; ++i) {
        const Eigen::Vector3d u = 0.01 * i * target, force = contact.step(touch + u).force;
        if (i % 10 == 0) EXPECT_LT((force - local.evaluate(u, jacobian)).norm(), 1e-6 * force.norm());
      }
    }
  }
}

/// In, about, out of the range and of the contact, and back to the start: what the needle got back it had put in.
TEST(PreparedContact, ClosedPathsCreateNoEnergy) {
  const Scene scene = pipette();
  const auto rough = springs(scene);
  Eigen::VectorXd coefficients = rough->energy.coefficients();
  for (Eigen::Index i = 1; i < coefficients.size(); ++i)
    coefficients[i] = 0.02 * std::sin(7.0 * static_cast<double>(i));
  rough->energy.setCoefficients(coefficients);
  for (const auto& cell : {rough, fieldOfSprings(scene, 0.3), fieldOfSprings(scene, -0.3)}) {
    PreparedContact contact(scene, cell);
    for (unsigned seed = 1; seed <= 20; ++seed) {
      std::srand(seed);
      Eigen::Vector3d tip(0, 0, 29e-6), force = Eigen::Vector3d::Zero();
      double work = 0, all = 0;
      const auto go = [&](const Eigen::Vector3d& target) {
        const int steps = 4000;
        const Eigen::Vector3d move = (target - tip) / steps;
        for (int i = 0; i < steps; ++i) {
          tip += move;
          const Eigen::Vector3d now = contact.step(tip).force;
          work += 0.5 * (force + now).dot(move);
          all += std::abs(0.5 * (force + now).dot(move));
          force = now;
        }
      };
      for (int leg = 0; leg < 6; ++leg) {
        const Eigen::Vector3d target = Eigen::Vector3d::Random();
        go({15e-6 + 6e-6 * target.x(), 6e-6 * target.y(), 16e-6 + 14e-6 * target.z()});
      }
      go({15e-6, 0, 34e-6});
      EXPECT_LT(work, 1e-4 * all) << "seed " << seed;
    }
  }
}

/// What a field that is no gradient would give for nothing: the same loop again and again.
TEST(PreparedContact, ALoopIsNoEngine) {
  const Scene scene = pipette();
  for (const double more : {0.3, -0.3}) {
    for (const double sense : {1.0, -1.0}) {
      PreparedContact contact(scene, fieldOfSprings(scene, more));
      contact.step({0, 0, 27.99e-6});
      double work = 0, round = 0;
      Eigen::Vector3d tip(0, 0, 20e-6), force = contact.step(tip).force;
      for (int i = 1; i <= 40000; ++i) {
        const double turn = sense * 2 * 3.14159265358979 * i / 1000;
        const Eigen::Vector3d next(2e-6 * std::sin(turn), 0, 22e-6 - 2e-6 * std::cos(turn)),
            now = contact.step(next).force;
        work += 0.5 * (force + now).dot(next - tip);
        if (i > 20000) round += 0.5 * (force + now).dot(next - tip);
        tip = next;
        force = now;
      }
      EXPECT_LT(round, 1e-4 * std::abs(force.z()) * 4e-6);
    }
  }
}

/// Vibrating at 200 Hz and 5 um, in and out of the cell at 100 Hz, across it, out of the range, 20 um in one step:
/// finite and bounded by what is felt at the range's border.
TEST(PreparedContact, NoMotionMakesTheForceLeap) {
  const Scene scene = pipette();
  const auto cell = fieldOfSprings(scene, 0.1);
  PreparedContact contact(scene, cell), other(scene, cell);
  other.step({0, 0, 27.9e-6});
  const double largest = 1.3 * other.step({0, 0, 28e-6 - cell->range.axis_depth}).force.norm();
  int touched = 0;
  for (int i = 0; i < 100000; ++i) {
    const double time = 1e-5 * i, pi = 3.14159265358979;
    Eigen::Vector3d tip(5e-6 * std::sin(2 * pi * 3 * time), 5e-6 * std::sin(2 * pi * 200 * time),
                        26e-6 + 5e-6 * std::sin(2 * pi * 100 * time));
    if (i % 500 == 0) tip.z() -= 20e-6;
    const Eigen::Vector3d force = contact.step(tip).force;
    ASSERT_TRUE(force.allFinite());
    ASSERT_LT(force.norm(), largest);
    if (contact.place()) ++touched;
  }
  EXPECT_GT(touched, 30000);
  EXPECT_LT(touched, 90000);
  EXPECT_TRUE(contact.step({0, 0, 35e-6}).force.isZero(0));
}

/// A flat disc under the cell's equator still touches it.
TEST(PreparedContact, ADiscStaysInContactDownToTheRangesEnd) {
  Scene scene = pipette();
  scene.needle.tip.shape = "disc";
  PreparedContact contact(scene, springs(scene));
  double last = 0;
  for (double z = 27.99e-6; z > -16e-6; z -= 0.1e-6) {
    const double force = contact.step({0, 0, z}).force.z();
    ASSERT_GT(force, last);
    last = force;
  }
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
  Scene relaxing = scene;
  relaxing.cell.material().viscoelasticity.prony = {{0.5, 0.2}};
  EXPECT_NO_THROW(Preparation::check(relaxing));
  const PreparationRange range = PreparationRange::standard(scene);
  EXPECT_EQ(Preparation::plan(scene, range).description(scene),  // one equilibrium
            Preparation::plan(relaxing, range).description(relaxing));
  Scene viscous = scene, rubbing = scene, different = relaxing;
  viscous.cell.material().viscoelasticity.viscosity = 1;
  rubbing.needle.contact = {"sliding", 0.2};
  different.cell.layers.push_back(different.cell.layers.front());
  different.cell.layers.back().outer_radius /= 2;
  different.cell.layers.back().material.viscoelasticity.prony[0].relaxation_time = 1;
  for (const Scene& bad : {viscous, rubbing, different}) EXPECT_THROW(Preparation::check(bad), ConfigError);
}

/// A step relaxes exponentially to the elastic force, whatever the period of the steps.
TEST(ForceMemory, RelaxesAsItsTermsSay) {
  const Eigen::Vector3d force(0, 0, 2);
  for (const double period : {1e-3, 0.05}) {
    ForceMemory memory({{0.5, 0.2}, {0.3, 2}});
    EXPECT_NEAR(memory.step(force, 0).z(), 0.8 * 2, 1e-12);
    double time = 0;
    Eigen::Vector3d more = Eigen::Vector3d::Zero();
    for (; time < 0.5 - 1e-9; time += period) more = memory.step(force, period);
    EXPECT_NEAR(more.z(), 2 * (0.5 * std::exp(-0.5 / 0.2) + 0.3 * std::exp(-0.5 / 2)), 1e-9);
    memory.reset();
    EXPECT_TRUE(memory.step(Eigen::Vector3d::Zero(), 1).isZero(0));
  }
  ForceMemory even({{0.5, 0.2}});  // a ramp of 1 N/s: beta tau (1 - exp(-t / tau))
  double last = 0;
  for (int i = 1; i <= 10; ++i) last = even.step({0, 0, 0.1 * i}, 0.1).z();
  EXPECT_NEAR(last, 0.5 * 0.2 * (1 - std::exp(-1 / 0.2)), 1e-12);
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
  EXPECT_TRUE(tracker.step({0, 0, -20e-6}, up, 3e-3).trusted);  // out of the range the force fades
  EXPECT_NE(tracker.distrust(), "");
  EXPECT_TRUE(tracker.step(deep, up, 4e-3).trusted);
  EXPECT_EQ(tracker.distrust(), "");

  PreparedTracker beside(scene, cell);  // touches at 75 degrees
  const TipForce far_out = beside.step({ContactPlace::offsetFor(scene, 1.3).x(), 0, 0}, up, 0);
  EXPECT_FALSE(far_out.trusted);
  EXPECT_TRUE(far_out.force.isZero(0));
  EXPECT_NE(beside.distrust(), "");

  scene.cell.puncture_force = 0.5 * force.force.z();
  PreparedTracker weak(scene, cell);
  EXPECT_GT(weak.step({0, 0, 27e-6}, up, 0).force.z(), 0);
  EXPECT_TRUE(weak.step(deep, up, 1e-3).force.isZero(0));
  EXPECT_TRUE(weak.punctured());
  EXPECT_FALSE(weak.contact());
  EXPECT_TRUE(weak.step(deep, up, 2e-3).force.isZero(0));
}

/// In and out of the cell at places all over it, sideways, out of the range, tilted, and through puncture.
TEST(PreparedTracker, AStepAllocatesNothing) {
  for (const char* shape : {"disc", "hemisphere", "rounded_flat"}) {
    Scene scene = pipette();
    scene.needle.tip.shape = shape;
    if (scene.needle.tip.shape == "rounded_flat") scene.needle.tip.edge_radius = 1e-6;
    const auto cell = springs(scene);
    scene.cell.puncture_force = 1;  // N, never
    PreparedTracker tracker(scene, cell);
    scene.cell.puncture_force = 1e-9;
    PreparedTracker weak(scene, cell);
    int touched = 0, untrusted = 0;
    const std::size_t before = allocationCount();
    for (int i = 0; i < 3000; ++i) {
      const double way = 0.01 * i, side = 20e-6 * std::sin(0.05 * way);
      const Eigen::Vector3d tip(side, 3e-6 * std::sin(7 * way), 20e-6 + 20e-6 * std::cos(way));
      const Eigen::Vector3d axis = i % 10 == 0 ? Eigen::Vector3d(0.6, 0, 0.8) : Eigen::Vector3d::UnitZ();
      if (!tracker.step(tip, axis, 1e-3 * i).trusted) ++untrusted;
      if (tracker.contact()) ++touched;
      weak.step(tip, axis, 1e-3 * i);
    }
    EXPECT_EQ(allocationCount(), before) << shape;
    EXPECT_GT(touched, 300);
    EXPECT_LT(touched, 2700);
    EXPECT_GT(untrusted, 30);
    EXPECT_TRUE(weak.punctured());
  }
}

}  // namespace
}  // namespace microinjection
