// What any rig behind the /needle topics must keep to, and how its node tells it.
// test/hardware/devices/contract_test.cpp asks the same of the drivers, and more of their motion.

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "hardware/devices/driver_registry.h"
#include "needle_bench.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kRigStart(0, 0, 60e-6);      // m
const Eigen::Vector3d kRigPlace(10e-6, 0, 70e-6);  // m

struct RigSet {
  std::string name, rig, changes = "{}";
};

std::vector<RigSet> rigSets() {
  std::vector<RigSet> sets{{"sim", "sim"}};
  for (const DriverEntry& rig : driverEntries()) sets.push_back({rig.name, "emulated_" + rig.name});
  // A USB adapter whose latency timer is as delivered, and three devices with an axis each on one line.
  sets.push_back({"scientifica_slow", "emulated_scientifica", "{emulator: {latency: 0.018}}"});
  sets.push_back({"zaber_chain", "emulated_zaber",
                  "{device: {devices: [1, 2, 3], axes: [1, 1, 1]}, "
                  "emulator: {chained: true, alerts: true, info_every: 3}}"});
  sets.push_back({"external", "external"});
  sets.push_back({"external_poses", "external", "{device: {positions: poses}}"});
  return sets;
}

class RigNode : public testing::TestWithParam<RigSet> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; })) << bench_.status();
    near_ = 1.5 * std::max(bench_.abilities().resolution, 1e-9) + 1e-9;
    goTo(kRigStart);
  }

  bool isAt(const Eigen::Vector3d& target) { return (bench_.needle() - target).norm() <= near_ * std::sqrt(3.0); }
  void goTo(const Eigen::Vector3d& target) {
    const ros::Time sent = bench_.session.now();
    bench_.move(target);
    const auto arrived = [&] { return isAt(target) && !bench_.busy() && bench_.states.newest()->header.stamp > sent; };
    ASSERT_TRUE(bench_.until(arrived)) << "at " << bench_.needle().transpose() << ": " << bench_.status();
  }
  /// Two readings of a place may be off by a count each.
  void expectStands(double seconds = 0.5) { EXPECT_LE(bench_.strays(seconds), 2 * near_); }
  void setOff(const Eigen::Vector3d& target) {
    bench_.move(target);
    ASSERT_TRUE(bench_.until([&] { return bench_.needle().x() > 5e-6; }));
  }
  bool simulated() { return GetParam().rig == "sim"; }

  NeedleBench bench_{GetParam().rig, GetParam().changes};
  double near_ = 0;  // m
};

TEST_P(RigNode, WhatItCannotDoIsRefusedAndMovesNothing) {
  const std::pair<Eigen::Vector3d, std::string> refused[] = {
      {{1, 0, 0}, "manipulator_x = 1 m, allowed"}, {{0, 0, -1e-3}, "manipulator_z"}, {{NAN, 0, 0}, "not a valid pose"}};
  for (const auto& [target, why] : refused) {
    SCOPED_TRACE(why);
    bench_.session.diagnostics().clear();
    bench_.move(target);
    bench_.run(0.2);
    EXPECT_TRUE(contains(bench_.status(), "move_cp refused: "));
    EXPECT_TRUE(contains(bench_.status(), why));
    bench_.servo(poseAt(target));
    bench_.run(0.2);
    bench_.silence();
    EXPECT_TRUE(contains(bench_.status(), "servo_cp refused: "));
    EXPECT_TRUE(contains(bench_.status(), why));
    EXPECT_TRUE(isNear(bench_.needle(), kRigStart, near_));
  }
  bench_.world.sayNow("needle/servo_cv", velocityMessage(1, "world"));
  bench_.run(0.2);
  EXPECT_TRUE(contains(bench_.status(), "velocity = 1"));
  EXPECT_TRUE(isNear(bench_.needle(), kRigStart, near_));
}

TEST_P(RigNode, AStopIsToldInTime) {
  for (const int milliseconds : {137, 211, 333}) {
    SCOPED_TRACE(milliseconds);
    goTo(kRigStart);
    setOff({2e-3, 0, 60e-6});
    bench_.run(1e-3 * milliseconds);
    const auto& abilities = bench_.abilities();
    const ros::Time said = bench_.session.now();
    const Eigen::Vector3d before = bench_.needle();
    EXPECT_TRUE(bench_.busy());
    bench_.command("stop");
    ASSERT_TRUE(bench_.until([&] { return !bench_.busy(); }));
    EXPECT_LE(secondsBetween(said, bench_.states.newest()->header.stamp),
              0.05 + abilities.stop_time + abilities.reading_interval + 1e-3);
    bench_.run(0.05 + abilities.stop_time + abilities.reading_interval + 1e-3);
    EXPECT_LE((bench_.needle() - before).norm(), abilities.speed * (0.05 + abilities.stop_time));
    expectStands();
  }
}

/// Faults of this rig, and whether they wait for enable; it may get over the others by itself.
std::map<std::string, bool> faultsOf(const std::string& rig) {
  if (rig == "sim") return {{"error:4", true}};
  if (rig == "external") return {{"silence:1.5", false}, {"silence:4", false}, {"error:4", true}};
  if (rig == "emulated_zaber")
    return {{"silence:1.5", false}, {"silence:4", true}, {"error:BADDATA", true}, {"error:FS", true}};
  return {{"silence:1.5", false}, {"silence:4", true}, {"error:4", false}};
}

TEST_P(RigNode, AFaultWaitsForEnable) {
  const Eigen::Vector3d target(30e-6, 0, 60e-6), later(60e-6, 0, 60e-6);  // m
  for (const auto& [fault, stays] : faultsOf(GetParam().rig)) {
    SCOPED_TRACE(fault);
    goTo(kRigStart);
    bench_.inject(fault);
    bench_.run(0.003);
    bench_.move(target);
    ASSERT_TRUE(bench_.until([&] { return bench_.state() != "ENABLED" || (isAt(target) && !bench_.busy()); }));
    if (stays) {  // a device that is silent is DISABLED first
      ASSERT_TRUE(bench_.until([&] { return bench_.state() == "FAULT"; })) << bench_.state();
    }
    if (bench_.state() != "ENABLED") {
      bench_.session.diagnostics().clear();
      bench_.move(later);
      bench_.run(5);  // longer than any silence
      EXPECT_TRUE(bench_.session.diagnostics().ever(kNeedleStatus, "move_cp refused"));
      EXPECT_TRUE(!stays || bench_.state() == "FAULT") << bench_.state();
      bench_.command("enable");
      ASSERT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; })) << bench_.status();
    }
    expectStands();
    EXPECT_LE(bench_.needle().x(), target.x() + 2 * near_) << "what was refused was done";
    goTo(kRigPlace);
  }
}

TEST_P(RigNode, APulledCableIsToldAndNothingBeginsAnew) {
  if (simulated()) return;  // it has no cable
  setOff({500e-6, 0, 60e-6});
  bench_.inject("pull:2.0");
  ASSERT_TRUE(bench_.until([&] { return bench_.state() == "DISABLED"; }));
  ASSERT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; })) << bench_.status();
  expectStands(1);
  goTo(kRigPlace);
}

TEST_P(RigNode, AbilitiesAreHeardByWhoComesLate) {
  TestNode& late = bench_.session.addTestNode("late");
  const auto& heard = late.hear<cell_microinjection::ManipulatorAbilities>("needle/abilities");
  bench_.run(0.002);
  ASSERT_TRUE(heard.newest());
  EXPECT_EQ(heard.newest()->speed, bench_.abilities().speed);
  EXPECT_EQ(heard.newest()->device == "simulated", simulated());
}

INSTANTIATE_TEST_SUITE_P(Rigs, RigNode, testing::ValuesIn(rigSets()), [](const auto& info) { return info.param.name; });

TEST(RigNodeAbilities, TellOfASlowLine) {
  std::map<std::string, cell_microinjection::ManipulatorAbilities> told;
  for (const RigSet& set : rigSets()) {
    if (set.rig != "emulated_scientifica") continue;
    NeedleBench bench(set.rig, set.changes);
    ASSERT_TRUE(bench.until([&] { return bench.state() == "ENABLED"; }));
    told[set.name] = bench.abilities();
  }
  EXPECT_GE(told["scientifica_slow"].latency, told["scientifica"].latency + 0.018);
  EXPECT_GE(told["scientifica_slow"].reading_interval, told["scientifica"].reading_interval + 0.018);
  // The adapter holds answers back, and no stop.
  EXPECT_EQ(told["scientifica_slow"].stop_time, told["scientifica"].stop_time);
}

}  // namespace
}  // namespace microinjection
