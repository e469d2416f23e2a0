#include "cell/surrogate/surrogate_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cell/surrogate/spring_cells.h"

namespace microinjection {
namespace {

TEST(SurrogateContact, TouchesFollowsAndLoses) {
  const Scene scene = pipette();
  SurrogateContact contact(scene, springs(scene));
  EXPECT_TRUE(contact.step({0, 0, 28.1e-6}).force.isZero(0));
  EXPECT_FALSE(contact.contactFrame());
  const auto touched = contact.step({0, 0, 27e-6});
  ASSERT_TRUE(contact.contactFrame());
  EXPECT_GT(touched.force.z(), 0);
  EXPECT_TRUE(touched.prepared);
  const auto aside = contact.step({1e-6, 2e-6, 26e-6});
  EXPECT_LT(aside.force.x(), 0);  // the cell pulls back
  EXPECT_NEAR(aside.force.y() / aside.force.x(), 2, 1e-9);
  EXPECT_NEAR(contact.displacement().z(), -2e-6, 1e-15);
  contact.step({1e-6, 2e-6, 28.2e-6});
  EXPECT_FALSE(contact.contactFrame());
}

/// Beside the axis the same happens in a turned frame.
TEST(SurrogateContact, TurnsWithThePlace) {
  const Scene scene = pipette();
  SurrogateContact contact(scene, springs(scene)), turned(scene, springs(scene));
  const double height = ContactFrame::at(scene, {12e-6, 0})->origin.z();
  contact.step({12e-6, 0, height - 1e-9});
  turned.step({0, 12e-6, height - 1e-9});
  const Eigen::Vector3d a = contact.step({11e-6, 2e-6, height - 3e-6}).force;
  const Eigen::Vector3d b = turned.step({-2e-6, 11e-6, height - 3e-6}).force;
  EXPECT_LT((Eigen::Vector3d(-a.y(), a.x(), a.z()) - b).norm(), 1e-12 * a.norm());
}

TEST(SurrogateContact, OutOfItsRangeItIsContinuousFadesAndSaysSo) {
  const Scene scene = pipette();
  const auto cell = springs(scene);
  for (const double offset : {0.0, 12e-6}) {  // on the axis the range is deeper
    SurrogateContact contact(scene, cell);
    const double top = ContactFrame::at(scene, {offset, 0})->origin.z();
    const double border = top - (offset == 0 ? cell->range.axis_depth : cell->range.depth);
    contact.step({offset, 0, top - 1e-8});
    const auto inside = contact.step({offset, 0, border + 1e-10}), outside = contact.step({offset, 0, border - 1e-10});
    EXPECT_TRUE(inside.prepared);
    EXPECT_FALSE(outside.prepared);
    EXPECT_NEAR(outside.force.z() / inside.force.z(), 1, 1e-3);
    EXPECT_LT(contact.step({offset, 0, border - 10e-6}).force.norm(), 0.2 * inside.force.norm());
  }
  SurrogateContact contact(scene, cell);
  contact.step({12e-6, 0, 25e-6});
  const double side = cell->range.lateral;
  const auto at = contact.step({12e-6, side - 1e-10, 20e-6}), over = contact.step({12e-6, side + 1e-10, 20e-6});
  EXPECT_TRUE(at.prepared);
  EXPECT_FALSE(over.prepared);
  EXPECT_LT((at.force - over.force).norm(), 1e-3 * at.force.norm());
}

/// Straight in from the touch the force is the field's, although that is no gradient.
TEST(SurrogateContact, FollowsTheFieldOnStraightPaths) {
  const Scene scene = pipette();
  const auto cell = fieldOfSprings(scene, 0.05);
  ForceField::Local local;
  for (const double offset : {0.0, 12e-6}) {
    const Eigen::Vector3d touch = ContactFrame::at(scene, {offset, 0})->origin;
    cell->field.makeLocal(ContactFrame::at(scene, {offset, 0})->angle, local);
    for (const Eigen::Vector3d& target : {Eigen::Vector3d(2e-6, 3e-6, -12e-6), Eigen::Vector3d(-4e-6, 0, -3e-6)}) {
      SurrogateContact contact(scene, cell);
      contact.step(touch - Eigen::Vector3d(0, 0, 1e-12));
      Eigen::Matrix3d jacobian;
      for (int i = 1; i <= 100; ++i) {
        const Eigen::Vector3d u = 0.01 * i * target, force = contact.step(touch + u).force;
        if (i % 10 == 0) EXPECT_LT((force - local.evaluate(u, jacobian)).norm(), 1e-6 * force.norm());
      }
    }
  }
}

/// Vibrating at 200 Hz and 5 um, in and out of the cell at 100 Hz, across it, out of the range, 20 um in one step:
/// finite and bounded by what is felt at the range's border.
TEST(SurrogateContact, NoMotionMakesTheForceLeap) {
  const Scene scene = pipette();
  const auto cell = fieldOfSprings(scene, 0.1);
  SurrogateContact contact(scene, cell), other(scene, cell);
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
    if (contact.contactFrame()) ++touched;
  }
  EXPECT_GT(touched, 30000);
  EXPECT_LT(touched, 90000);
  EXPECT_TRUE(contact.step({0, 0, 35e-6}).force.isZero(0));
}

/// A flat disc under the cell's equator still touches it.
TEST(SurrogateContact, ADiscStaysInContactDownToTheRangesEnd) {
  Scene scene = pipette();
  scene.needle.tip.shape = "disc";
  SurrogateContact contact(scene, springs(scene));
  double last = 0;
  for (double z = 27.99e-6; z > -16e-6; z -= 0.1e-6) {
    const double force = contact.step({0, 0, z}).force.z();
    ASSERT_GT(force, last);
    last = force;
  }
}

}  // namespace
}  // namespace microinjection
