// What every rig must keep to behind Micromanipulator; test/nodes/needle/rig_node_test.cpp asks it of the node: the
// simulated one, and real ones as delivered, with answers that come 18 ms later, and (Zaber) as a chain of devices with
// alerts and info lines.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "../manipulator/rig_file.h"
#include "hardware/devices/driver_registry.h"
#include "hardware/devices/needle_loop.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/simulated_manipulator.h"
#include "hardware/serial/emulated_wire.h"
#include "hardware/serial/fault.h"

namespace microinjection {
namespace {

constexpr double kStale = 0.1;              // s, of MicromanipulatorConfig
constexpr double kCommandedSpeed = 20e-6;   // m/s
const Eigen::Vector3d kStart(0, 0, 60e-6);  // m

struct Variant {
  std::string rig, name;
  double held = 0;  // s
  bool chained = false;
};

std::vector<Variant> variants() {
  std::vector<Variant> all{{"sim", "plain"}, {"zaber", "chain", 0, true}, {"zaber", "slow_chain", 18e-3, true}};
  for (const DriverEntry& rig : driverEntries()) {
    all.push_back({rig.name, "plain"});
    all.push_back({rig.name, "slow", 18e-3});
  }
  return all;
}

class ContractTest : public testing::TestWithParam<Variant> {
 protected:
  void SetUp() override {
    simulated() ? makeSimulated() : makeEmulated();
    needle_ = std::make_unique<Micromanipulator>(geometry_, CollisionGuard(rigUrdf(), geometry_, 2e-6),
                                                 MicromanipulatorConfig(), *device_);
    ASSERT_TRUE(until([&] { return ready(); })) << device_->reason();
    near_ = 1.5 * std::max(device_->abilities().resolution, 1e-9) + 1e-9;
    goTo(kStart);
  }

  bool simulated() const { return GetParam().rig == "sim"; }
  static YAML::Node rigFile() {
    return loadYamlMap(MICROINJECTION_SOURCE_DIR "/config/rigs/" + GetParam().rig + ".yaml");
  }
  void makeSimulated() {
    ConfigReader reader(rigFile(), "sim");
    auto simulated = std::make_unique<SimulatedManipulator>(geometry_, SimulatedManipulatorConfig::read(reader));
    reader.finish();
    inject_ = [device = simulated.get()](const std::string& fault) { device->injectFault(fault); };
    device_ = std::move(simulated);
  }
  void makeEmulated() {
    const DriverEntry& rig = findDriver(GetParam().rig);
    YAML::Node config = rigFile();
    const auto emulator = rig.make_emulator();
    inject_ = [emulator](const std::string& fault) { emulator->inject(parseFault(fault)); };
    if (GetParam().chained) {
      config["devices"] = std::vector<int>{1, 2, 3};
      config["axes"] = std::vector<int>{1, 1, 1};
      ConfigReader reader(YAML::Load("{chained: true, alerts: true, info_every: 3}"), "emulator");
      emulator->configure(reader);
      reader.finish();
    }
    ConfigReader reader(config, rig.name);
    auto wire = std::make_unique<EmulatedWire>(emulator, rig.default_baud, GetParam().held);
    wire_ = wire.get();
    device_ = rig.make_driver(reader, std::move(wire));
  }

  void tick(const std::function<void()>& command = nullptr) {
    if (command) command();
    needle_->step(time_ += kStep, kStep);
  }
  void run(double duration, const std::function<void()>& command = nullptr) {
    for (int i = 0; i < std::lround(duration / kStep); ++i) tick(command);
  }
  bool until(const std::function<bool()>& done, const std::function<void()>& command = nullptr) {
    for (int i = 0; i < 20000; ++i) {
      if (done()) return true;
      tick(command);
    }
    return false;
  }
  bool ready() const { return device_->state() == ManipulatorDevice::State::kReady; }
  bool busy() const { return needle_->moving() || device_->moving(); }
  Eigen::Vector3d place() const { return needle_->tipPose()->translation(); }
  Eigen::Isometry3d pose(const Eigen::Vector3d& place) const {
    Eigen::Isometry3d result = geometry_.tip_at_zero;
    result.translation() = place;
    return result;
  }
  bool isAt(const Eigen::Vector3d& target) const {
    return needle_->tipPose() && (place() - target).norm() <= near_ * std::sqrt(3.0);
  }
  void goTo(const Eigen::Vector3d& target) {
    ASSERT_EQ(needle_->movePosition(pose(target)), "");
    ASSERT_TRUE(until([&] { return isAt(target) && !busy(); })) << device_->reason() << needle_->abortReason();
  }
  void expectStands(double duration = 0.5, const std::function<void()>& command = nullptr) {
    const Eigen::Vector3d held = place();
    double off = 0;
    for (int i = 0; i < std::lround(duration / kStep); ++i) {
      tick(command);
      off = std::max(off, (place() - held).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(off, 2 * near_);
  }
  /// The end is a true reading: what was carried on until then may be a little beside it.
  void expectHoldsAfterSilence() {
    const ManipulatorAbilities abilities = device_->abilities();
    const Eigen::Vector3d told = place();
    run(kStale + 0.05 + abilities.stop_time + abilities.reading_interval + kStep);
    EXPECT_LE((place() - told).norm(),
              kCommandedSpeed * (kStale + 0.05 + abilities.stop_time + abilities.command_interval) + 2 * near_);
    expectStands();
  }

  ManipulatorGeometry geometry_ = ManipulatorGeometry::fromUrdf(rigUrdf(), 0);
  EmulatedWire* wire_ = nullptr;  ///< null: the simulated rig has none
  std::function<void(const std::string& fault)> inject_;
  std::unique_ptr<ManipulatorDevice> device_;
  std::unique_ptr<Micromanipulator> needle_;
  double time_ = 0;  // s
  double near_ = 0;  // m
};

TEST_P(ContractTest, MovesArriveAndStayAndTheNewestWins) {
  for (const Eigen::Vector3d& target : {Eigen::Vector3d(20e-6, 0, 60e-6),
                                        {20e-6, -15e-6, 90e-6},
                                        {-3e-6, 4e-6, 50e-6},
                                        {200e-6, 100e-6, 300e-6},
                                        kStart}) {
    goTo(target);
    expectStands(0.3);
    EXPECT_TRUE(isAt(target));
  }
  for (int x = 1; x < 8; ++x) {
    ASSERT_EQ(needle_->movePosition(pose({x * 10e-6, 0, 60e-6})), "");
    run(3 * kStep);
  }
  ASSERT_TRUE(until([&] { return isAt({70e-6, 0, 60e-6}) && !busy(); }));
  expectStands();
  EXPECT_TRUE(isAt({70e-6, 0, 60e-6}));
}

TEST_P(ContractTest, RefusesWhatItCannotDoAndStays) {
  const std::pair<Eigen::Vector3d, std::string> refused[] = {
      {{1, 0, 0}, "manipulator_x = 1 m, allowed"}, {{0, 0, -1e-3}, "manipulator_z"}, {{NAN, 0, 0}, "not finite"}};
  const auto expectRefused = [&](const std::string& refusal, const std::string& why) {
    ASSERT_NE(refusal.find(why), std::string::npos) << refusal;
  };
  for (const auto& [target, why] : refused) {
    SCOPED_TRACE(why);
    expectRefused(needle_->movePosition(pose(target)), why);
    run(0.2, [&, &goal = target, &reason = why] { expectRefused(needle_->servoPosition(pose(goal)), reason); });
    EXPECT_LE((place() - kStart).cwiseAbs().maxCoeff(), near_);
  }
  expectRefused(needle_->servoVelocity({1, 0, 0}, time_), "velocity = 1");
  run(0.2);
  EXPECT_LE((place() - kStart).cwiseAbs().maxCoeff(), near_);
}

TEST_P(ContractTest, FollowsAsCloselyAsItSays) {
  const ManipulatorAbilities abilities = device_->abilities();
  const double allowed =
      kCommandedSpeed * (2 * abilities.command_interval + abilities.reading_interval + abilities.latency + 0.02) +
      2 * near_;
  double z = kStart.z(), behind = 0, ahead = 0;  // m
  const auto command = [&] { needle_->servoPosition(pose({0, 0, z})); };
  for (int i = 0; i < 1500; ++i) {
    z -= kCommandedSpeed * kStep;
    tick(command);
    ASSERT_TRUE(needle_->tipPose());
    behind = std::max(behind, place().z() - z);
    ahead = std::max(ahead, z - place().z());
  }
  EXPECT_LE(behind, allowed);
  EXPECT_LE(ahead, 2 * near_ + kCommandedSpeed * 0.02);
  ASSERT_TRUE(until([&] { return isAt({0, 0, z}) && !device_->moving(); }, command));
  run(0.5, command);  // what was carried on becomes a true reading
  EXPECT_TRUE(isAt({0, 0, z}));
  ASSERT_TRUE(until([&] { return !busy(); }));
  expectStands();
  EXPECT_TRUE(isAt({0, 0, z}));
}

TEST_P(ContractTest, StopsInTheTimeThatItSays) {
  for (const int ticks : {137, 211, 333}) {
    goTo(kStart);
    needle_->movePosition(pose({2e-3, 0, 60e-6}));
    ASSERT_TRUE(until([&] { return needle_->tipPose() && place().x() > 5e-6; }));
    run(ticks * kStep);
    needle_->stop();
    const Eigen::Vector3d told = place();
    const ManipulatorAbilities abilities = device_->abilities();
    run(0.05 + abilities.stop_time + abilities.reading_interval + kStep);
    EXPECT_FALSE(busy());
    EXPECT_LE((place() - told).norm(), abilities.speed * (0.05 + abilities.stop_time));
    expectStands();
  }
}

TEST_P(ContractTest, StaleCommandsHold) {
  double z = kStart.z();
  for (int i = 0; i < 700; ++i) {
    z += kCommandedSpeed * kStep;
    tick([&] { needle_->servoPosition(pose({0, 0, z})); });
  }
  expectHoldsAfterSilence();
  goTo(kStart);
  for (int i = 0; i < 70; ++i) {
    needle_->servoVelocity({kCommandedSpeed, 0, 0}, time_);
    run(0.01);
  }
  EXPECT_GT(place().x(), 2e-6);
  expectHoldsAfterSilence();
}

TEST_P(ContractTest, AStreamThatGoesOnAfterAStopMovesNothing) {
  double z = kStart.z();
  const auto stream = [&] { needle_->servoPosition(pose({0, 0, z += kCommandedSpeed * kStep})); };
  run(0.7, stream);
  EXPECT_GT(place().z(), kStart.z() + 2e-6);
  needle_->stop();
  run(1.5, stream);  // to come to rest
  expectStands(1, stream);
  run(kStale + 0.05);
  EXPECT_TRUE(until(
      [&] {
        return isAt({0, 0, z});
      },
      [&] {
        needle_->servoPosition(pose({0, 0, z}));
      }))
      << "after a pause it is a new stream";
}

/// Faults of a rig, and whether it waits for clearFault(); it may get over the others by itself.
std::map<std::string, bool> faultsOf(const std::string& rig) {
  if (rig == "sim") return {{"error:4", true}};
  if (rig == "zaber") return {{"silence:1.5", false}, {"silence:4", true}, {"error:BADDATA", true}, {"error:FS", true}};
  return {{"silence:1.5", false}, {"silence:4", true}, {"error:4", false}};
}

TEST_P(ContractTest, AFaultWaitsOrIsGotOverAndNothingGoesOn) {
  const Eigen::Vector3d target(30e-6, 0, 60e-6), later(60e-6, 0, 60e-6);  // m
  for (const auto& [fault, stays] : faultsOf(GetParam().rig)) {
    SCOPED_TRACE(fault);
    goTo(kStart);
    inject_(fault);
    needle_->movePosition(pose(target));
    ASSERT_TRUE(until([&] { return !ready() || (isAt(target) && !busy()); }));
    if (stays) {  // a device that is silent is disconnected first
      ASSERT_TRUE(until([&] { return device_->state() == ManipulatorDevice::State::kFault; })) << device_->reason();
    }
    if (!ready()) {
      EXPECT_NE(needle_->movePosition(pose(later)), "");
      run(5);  // longer than any silence
      EXPECT_TRUE(!stays || device_->state() == ManipulatorDevice::State::kFault) << "it waits for no one";
      needle_->clearFault();
      ASSERT_TRUE(until([&] { return ready(); })) << device_->reason();
    }
    expectStands();
    EXPECT_LE(place().x(), target.x() + 2 * near_) << "what was refused was done";
    goTo({10e-6, 0, 70e-6});
  }
}

TEST_P(ContractTest, APulledCableEndsInARest) {
  if (!wire_) return;  // the simulated rig has no cable
  needle_->movePosition(pose({500e-6, 0, 60e-6}));
  ASSERT_TRUE(until([&] { return needle_->tipPose() && place().x() > 5e-6; }));
  wire_->disconnectCable();
  ASSERT_TRUE(until([&] { return device_->state() == ManipulatorDevice::State::kDisconnected; }));
  run(2);
  EXPECT_FALSE(needle_->tipPose());
  wire_->connectCable();
  ASSERT_TRUE(until([&] { return ready(); })) << device_->reason();
  expectStands(1);
  goTo({10e-6, 0, 70e-6});
}

INSTANTIATE_TEST_SUITE_P(Rigs, ContractTest, testing::ValuesIn(variants()),
                         [](const auto& info) { return info.param.rig + "_" + info.param.name; });

}  // namespace
}  // namespace microinjection
