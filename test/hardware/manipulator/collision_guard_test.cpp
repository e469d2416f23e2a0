#include "hardware/manipulator/collision_guard.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <regex>

#include "base/errors.h"
#include "hardware/manipulator/rig_file.h"

namespace microinjection {
namespace {

class RigGuard : public testing::Test {
 protected:
  /// Joint positions (m) for the tip at x, y, z (um) in world.
  Eigen::Vector3d at(double x, double y, double z) const { return rig_.joints(1e-6 * Eigen::Vector3d(x, y, z)); }
  void expectBlocked(const std::string& reason, const std::string& mover, const std::string& obstacle) const {
    EXPECT_NE(reason.find(mover + " would"), std::string::npos) << reason;
    EXPECT_NE(reason.find(obstacle), std::string::npos) << reason;
  }

  ManipulatorGeometry rig_ = ManipulatorGeometry::fromUrdf(rigUrdf());
  CollisionGuard guard_{rigUrdf(), rig_, kMargin};
};

TEST_F(RigGuard, TheCellIsNoObstacle) {
  EXPECT_EQ(guard_.blocks(at(0, 0, 0)), "");
  EXPECT_EQ(guard_.blocksPath(at(0, 0, 60), at(0, 0, -25)), "");
}

TEST_F(RigGuard, DistancesAreThoseOfTheFile) {
  EXPECT_NEAR(guard_.clearance(at(0, 0, -10)), 18e-6, 1e-10);       // mouth at -28 um
  EXPECT_NEAR(guard_.clearance(at(200, 0, -40)), 20e-6, 1e-10);     // floor at -60 um
  EXPECT_NEAR(guard_.clearance(at(0, 0, 12e3)), 12.028e-3, 1e-10);  // the highest is still the mouth
  // Beside the holding pipette's rim, by the half sphere at the tip: its centre is 1 um above the tip.
  EXPECT_NEAR(guard_.clearance(at(34, 0, -26)), std::hypot(4e-6, 3e-6) - 1e-6, 1e-10);
  // Towards the corner of its travel the part of 0.1 mm comes to the plates at 17 mm from the centre.
  EXPECT_NEAR(guard_.clearance(at(11.45e3, 11.45e3, 1e3)), 17e-3 - std::hypot(11.45e-3, 11.45e-3) - 0.1e-3, 1e-9);
}

TEST_F(RigGuard, NamesBothLinksAndTheDistance) {
  EXPECT_EQ(guard_.blocks(at(0, 0, -25.99)), "");
  const std::string mouth = guard_.blocks(at(0, 0, -27));
  expectBlocked(mouth, "needle_tip", "holding_pipette");
  EXPECT_NE(mouth.find("1e-06 m"), std::string::npos) << mouth;
  expectBlocked(guard_.blocks(at(100, 0, -59)), "needle_tip", "dish");
  expectBlocked(guard_.blocks(at(100, 0, -130)), "needle_tip", "dish");  // within the axis' travel, below the floor
  EXPECT_EQ(rig_.outsideTravel(at(100, 0, -130)), "");
  expectBlocked(guard_.blocks(at(12.4e3, 12.4e3, 2e3)), "needle_tip", "dish");
}

TEST_F(RigGuard, AWayIsBlockedThoughItsEndsAreFree) {
  EXPECT_EQ(guard_.blocks(at(60, 0, -40)), "");
  EXPECT_EQ(guard_.blocks(at(-60, 0, -40)), "");
  expectBlocked(guard_.blocksPath(at(60, 0, -40), at(-60, 0, -40)), "needle_tip", "holding_pipette");
  EXPECT_EQ(guard_.blocksPath(at(60, 0, -40), at(60, 0, -20)), "");
  EXPECT_EQ(guard_.blocksPath(at(60, 0, -20), at(-60, 0, -20)), "");
  EXPECT_EQ(guard_.blocksPath(at(0, 0, 60), at(0, 0, 60)), "");
}

TEST_F(RigGuard, WhoIsTooNearMayLeaveOnly) {
  EXPECT_EQ(guard_.blocksPath(at(0, 0, -27), at(0, 0, 0)), "");
  EXPECT_NE(guard_.blocksPath(at(0, 0, -27), at(0, 0, -27.5)), "");
  EXPECT_NE(guard_.blocksPath(at(0, 0, -27), at(100, 0, -40)), "");  // it would cut through the rim
  EXPECT_EQ(guard_.blocksPath(at(0, 0, -27), at(10, 0, -27)), "");
}

/// An inverted microscope (doc/guide/your_camera.md): z lies flat, and y points up, from the dish.
TEST(TurnedDish, IsBelowAlongY) {
  std::string xml = rigUrdf();
  for (const char* name : {"dish", "objective"})
    xml = std::regex_replace(xml, std::regex(std::string("<joint name=\"world_to_") + name + "\" type=\"fixed\">"),
                             std::string("<joint name=\"turned_") + name +
                                 "\" type=\"fixed\"><origin xyz=\"0 20e-6 0\" rpy=\"-1.5707963 0 0\"/>");
  const auto at = [](double x, double y, double z) { return Eigen::Vector3d(1e-6 * Eigen::Vector3d(x, y, z - 60)); };
  const CollisionGuard straight(xml, ManipulatorGeometry::fromUrdf(xml), kMargin);
  EXPECT_NE(straight.blocks(at(0, 0, 28)).find("dish"), std::string::npos);  // the shaft lies in the floor
  const std::regex shaft(R"~(<collision>\s*<origin xyz="0 0 (-22.25e-3|0.555e-3|3.05e-3)"/>[\s\S]*?</collision>)~");
  const std::string bent = std::regex_replace(xml, shaft, "");  // what a bend lifts away from it
  const CollisionGuard guard(bent, ManipulatorGeometry::fromUrdf(bent), kMargin);
  EXPECT_EQ(guard.blocks(at(0, 0, 0)), "");
  EXPECT_EQ(guard.blocks(at(100, 100, -100)), "");  // beside the holding pipette, which lies along -z
  EXPECT_EQ(guard.blocks(at(100, -36, -100)), "");  // floor at -60 + 20 um
  EXPECT_NE(guard.blocks(at(100, -39, -100)).find("dish"), std::string::npos);
}

TEST_F(RigGuard, SeesTheTiltedPipette) {
  const double tilt = 1.2;
  const ManipulatorGeometry tilted = ManipulatorGeometry::fromUrdf(rigUrdf(), tilt);
  const CollisionGuard guard(rigUrdf(), tilted, kMargin);
  EXPECT_EQ(guard.blocks(at(0, 0, 60)), "");
  // Leaning to +x, it meets the wall there as it goes that way; and not as it goes the other way.
  expectBlocked(guard.blocks(at(8e3, 0, 60)), "pipette", "dish");
  EXPECT_EQ(guard.blocks(at(-8e3, 0, 60)), "");
  // The shaft's lower side passes over the wall's upper inner edge (17 mm, 4.94 mm): distance of the edge from its
  // axis.
  const double x = 4e-3, z = 2e-3;
  const double edge = std::cos(tilt) * (17e-3 - x) - std::sin(tilt) * (4.94e-3 - z);
  EXPECT_NEAR(guard.clearance(at(4e3, 0, 2e3)), edge - 0.5e-3, 1e-9);
}

/// With axes of its own the holding pipette is an obstacle where it is, and the needle one for it: the same two shapes,
/// and so the same distances.
TEST(TwoManipulators, AreObstaclesForEachOther) {
  std::string xml = rigUrdf();
  const std::string joint = R"(<joint name="world_to_holding_pipette" type="fixed">)";
  const std::size_t place = xml.find(joint);
  ASSERT_NE(place, std::string::npos);
  std::string axes, parent = "world";
  for (const char* axis : {"x", "y", "z"}) {
    const std::string name = std::string("holding_") + axis, link = "holding_stage_" + std::string(axis);
    axes += "<link name=\"" + link + "\"/><joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"" + parent +
            "\"/><child link=\"" + link + "\"/><axis xyz=\"" +
            (*axis == 'x'   ? "1 0 0"
             : *axis == 'y' ? "0 1 0"
                            : "0 0 1") +
            "\"/><limit lower=\"-0.01\" upper=\"0.01\" velocity=\"1e-3\" acceleration=\"0.1\" effort=\"1\"/></joint>";
    parent = link;
  }
  const std::size_t world = xml.find("<parent link=\"world\"/>", place);
  xml.replace(world, std::string("<parent link=\"world\"/>").size(), "<parent link=\"holding_stage_z\"/>");
  xml.insert(place, axes);
  const ManipulatorGeometry needle = ManipulatorGeometry::fromUrdf(xml);
  const ManipulatorGeometry holder = ManipulatorGeometry::fromUrdf(xml, 0, "holding_pipette");
  EXPECT_EQ(holder.tip_at_zero.translation(), Eigen::Vector3d(0, 0, -28e-6));
  EXPECT_THROW(CollisionGuard(xml, needle, kMargin), ConfigError) << "of whom are its axes?";

  CollisionGuard of_needle(xml, needle, kMargin, &holder);
  CollisionGuard of_holder(xml, holder, kMargin, &needle, CollisionGuard::Role::kSolid);
  const Eigen::Vector3d low(0, 0, -70e-6), here = Eigen::Vector3d::Zero();  // the tip at -10 um
  EXPECT_NEAR(of_needle.clearance(low), 18e-6, 1e-10);
  of_holder.placeOther(low);
  EXPECT_NEAR(of_holder.clearance(here), 18e-6, 1e-10);
  for (const double up : {5e-6, -20e-6}) {
    of_needle.placeOther({0, 0, up});
    EXPECT_NEAR(of_needle.clearance(low), 18e-6 - up, 1e-10);
    EXPECT_NEAR(of_holder.clearance({0, 0, up}), 18e-6 - up, 1e-10);
  }
  of_needle.placeOther({0, 0, 17e-6});
  EXPECT_NE(of_needle.blocks(low).find("needle_tip would come within 1e-06 m of holding_pipette"), std::string::npos)
      << of_needle.blocks(low);
  EXPECT_NE(of_holder.blocks({0, 0, 17e-6}).find("holding_pipette would come within 1e-06 m of needle_tip"),
            std::string::npos)
      << of_holder.blocks({0, 0, 17e-6});
  EXPECT_EQ(of_holder.blocks({0, 0, 15.9e-6}), "");
  EXPECT_EQ(of_holder.blocks({100e-6, 0, 0}), "") << "it comes through the dish, which is therefore no obstacle";
  EXPECT_NE(of_holder.blocks({0, 0, -0.35e-3}).find("objective"), std::string::npos);
  EXPECT_NE(of_holder.blocksPath({-100e-6, 0, 60e-6}, {100e-6, 0, 60e-6}), "") << "through the needle";
}

TEST_F(RigGuard, RefusesShapesThatItCannotKeepApart) {
  const auto with = [](const std::string& old_text, const std::string& new_text) {
    const std::string text = rigUrdf();
    const std::size_t place = text.find(old_text);
    EXPECT_NE(place, std::string::npos) << old_text;
    return text.substr(0, place) + new_text + text.substr(place + old_text.size());
  };
  const std::string moving_box = with(R"(<cylinder radius="1e-6" length="99e-6"/>)", R"(<box size="1 1 1"/>)");
  EXPECT_THROW(CollisionGuard(moving_box, rig_, kMargin), ConfigError);
  const std::string mesh = with(R"(<cylinder radius="1e-6" length="99e-6"/>)", R"(<mesh filename="a.stl"/>)");
  EXPECT_THROW(CollisionGuard(mesh, rig_, kMargin), ConfigError);
  const std::string loose = with(R"("world_to_objective" type="fixed")", R"("world_to_objective" type="floating")");
  EXPECT_THROW(CollisionGuard(loose, rig_, kMargin), ConfigError);
}

TEST_F(RigGuard, PrintsWhatAStepCosts) {
  const auto time = [](const std::function<void(int)>& work, int n) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < n; ++i) work(i);
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / n;
  };
  int blocked = 0;
  const double place = time([&](int i) { blocked += !guard_.blocks(at(i % 100, 0, 60 - i % 80)).empty(); }, 10000);
  const double step = time(
      [&](int i) {
        blocked += !guard_.blocksPath(at(i % 100, 0, 60 - i % 80), at(i % 100 + 1, 0, 60 - i % 80)).empty();
      },
      10000);
  const double across = time(
      [&](int i) { blocked += !guard_.blocksPath(at(-12e3, 300 + i % 100, -56), at(12e3, 0, 60 - i % 80)).empty(); },
      1000);
  std::printf("a place %.1f us, a way of 1 um %.1f us, a way through the dish %.1f us\n", place, step, across);
  EXPECT_EQ(blocked, 0);
}

}  // namespace
}  // namespace microinjection
