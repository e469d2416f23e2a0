#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hardware/devices/emulated_rig.h"
#include "hardware/devices/eppendorf/eppendorf_driver.h"
#include "hardware/devices/eppendorf/eppendorf_emulator.h"
#include "hardware/devices/mp285/mp285_driver.h"
#include "hardware/devices/mp285/mp285_emulator.h"
#include "hardware/devices/scientifica/scientifica_driver.h"
#include "hardware/devices/scientifica/scientifica_emulator.h"
#include "hardware/devices/sensapex/sensapex_driver.h"
#include "hardware/devices/sensapex/sensapex_emulator.h"
#include "hardware/devices/zaber/zaber_driver.h"
#include "hardware/devices/zaber/zaber_emulator.h"

namespace microinjection {

const Eigen::Vector3d kPlace(100e-6, -50e-6, 30e-6);  // m

/// What a test of any serial driver must know of one: its driver, its emulator, and how they are set up.
struct TestedZaber {
  using Driver = ZaberDriver;
  using Config = ZaberConfig;
  using Emulator = ZaberEmulator;
  using EmulatorConfig = ZaberEmulatorConfig;
  static constexpr char kName[] = "zaber";
  static constexpr double kStep = 0.047625e-6;   // m, a microstep
  static constexpr double kMotorStep = kStep;    // m
  static constexpr double kTold = 0.1 * kStep;   // m, by which a place that is told may be off
  static constexpr double kFastest = 2e-3;       // m/s
  static constexpr double kLongestBlind = 0.16;  // s without an answer that position is still told
  static constexpr char kLostReply[] = "drop:28", kSilence[] = "silence:0.3";
  static constexpr double kStopOnWire = 3 * 10 * 10.0 / 115200;  // s
  static constexpr bool kMovedByHand = true;                     // somebody else may move it

  static Config config() {
    Config config;
    config.joints.origin.setConstant(-12.5e-3);
    config.joints.directions << 1, 1, -1;
    config.joints.origin.z() = 12.5e-3;
    return config;
  }
  static Eigen::Vector3d inJointOrder(const Eigen::Vector3d& position) { return position; }
};

/// One that goes from one move to the next, with its axes in another order than the joints.
template <typename DriverType, typename ConfigType, typename EmulatorType, typename EmulatorConfigType>
struct TestedMoveByMove {
  using Driver = DriverType;
  using Config = ConfigType;
  using Emulator = EmulatorType;
  using EmulatorConfig = EmulatorConfigType;
  static constexpr double kFastest = 1e-3;      // m/s
  static constexpr double kLongestBlind = 1.5;  // s, a short move and its failed exchange
  static constexpr char kLostReply[] = "drop:1", kSilence[] = "silence:1.1";
  static constexpr bool kMovedByHand = true;
  static constexpr double kRamp = 0;         // s, that a move takes longer for each m/s of its speed
  static constexpr double kSlower = 0;       // share of a speed that is not used, where it is rounded
  static constexpr double kEndIsSeen = 1;    // s, until a move that was interrupted is begun again
  static constexpr double kMostMoves = 1.6;  // of a stream, in a turn as it is told
  static constexpr int kMovesAtMost = 2;     // in the place of one that is disturbed
  static constexpr bool kInParts = false;    // the way to a goal
  static constexpr double kLongestPart = std::numeric_limits<double>::infinity();  // s
  static constexpr double kPause = 0;                                              // s, between two parts

  static Config config() {
    Config config;
    config.axes.of_joint = {2, 0, 1};
    config.joints.directions << 1, -1, 1;
    config.joints.origin << 10e-6, 0, -20e-6;
    return config;
  }
  static Eigen::Vector3d inJointOrder(const Eigen::Vector3d& position) { return config().axes.inJointOrder(position); }
  static std::vector<EmulatorConfig> devices() { return {{}}; }
};

struct TestedMp285 : TestedMoveByMove<Mp285Driver, Mp285Config, Mp285Emulator, Mp285EmulatorConfig> {
  static constexpr char kName[] = "mp285";
  static constexpr bool kInParts = true;
  static constexpr double kLongestPart = 0.075;       // s
  static constexpr double kPause = 0.07;              // s: 31 bytes, and three answers and pauses
  static constexpr double kStep = 0.04e-6;            // m, a microstep
  static constexpr double kMotorStep = kStep;         // m
  static constexpr double kTold = 0.1 * kStep;        // m
  static constexpr double kStopOnWire = 10.0 / 9600;  // s
  /// m, by which a place may be off under way: the begin of a move is known to some ms.
  static double offUnderWay(double speed) { return 10e-3 * speed; }
  static std::vector<EmulatorConfig> devices() {
    std::vector<EmulatorConfig> all(4);
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].locks_up = i % 2 == 1;
      all[i].ascii_errors = i < 2;
    }
    return all;
  }
  static std::vector<std::string> faults() {
    return {"drop:1",  "deaf:1",  "deaf:4",  "garble:1", "garble:3",      "silence:0.1", "error:0",
            "error:1", "error:2", "error:4", "error:8",  "interrupt@0.9", "drop:1@0.9",  "silence:1@0.9"};
  }
};

struct TestedEppendorf
    : TestedMoveByMove<EppendorfDriver, EppendorfConfig, EppendorfEmulator, EppendorfEmulatorConfig> {
  static constexpr char kName[] = "eppendorf";
  static constexpr double kStep = 1e-6;                    // m, a count
  static constexpr double kMotorStep = 0.04e-6;            // m
  static constexpr double kTold = 0.5e-6;                  // m: a place is told as whole counts
  static constexpr double kStopOnWire = 7 * 10.0 / 19200;  // s
  static constexpr bool kMovedByHand = false;
  static constexpr double kSlower = 0.05;
  static constexpr double kMostMoves = 2;
  static constexpr double kEndIsSeen = 3;  // s: it does not tell that it stands
  /// m: what it moves in an exchange, and rounding.
  static double offUnderWay(double speed) { return 30e-3 * speed; }
  static std::vector<std::string> faults() {
    return {"drop:1",      "deaf:1",  "deaf:4",        "garble:1",   "garble:3",
            "silence:0.1", "error:4", "interrupt@0.9", "drop:1@0.9", "silence:0.5@0.9"};
  }
};

/// In microsteps.
struct TestedTransferman
    : TestedMoveByMove<EppendorfDriver, EppendorfConfig, TransfermanEmulator, TransfermanEmulatorConfig> {
  static constexpr char kName[] = "transferman";
  static constexpr double kStep = 1 / 25.6e6;    // m, a count
  static constexpr double kMotorStep = kStep;    // m
  static constexpr double kTold = 0.01 * kStep;  // m
  static constexpr char kSilence[] = "silence:1.3";
  static constexpr double kStopOnWire = TestedEppendorf::kStopOnWire;
  static constexpr bool kMovedByHand = false;
  static constexpr double kSlower = 0.05;
  static constexpr double kMostMoves = 2.6;  // its longest lines are twice as long as those of a stream
  static constexpr double kEndIsSeen = TestedEppendorf::kEndIsSeen;
  static double offUnderWay(double speed) { return TestedEppendorf::offUnderWay(speed); }
  static std::vector<std::string> faults() { return TestedEppendorf::faults(); }

  static Config config() {
    Config config = TestedMoveByMove::config();
    config.microsteps_per_metre = 25.6e6;
    return config;
  }
};

struct TestedScientifica
    : TestedMoveByMove<ScientificaDriver, ScientificaConfig, ScientificaEmulator, ScientificaEmulatorConfig> {
  static constexpr char kName[] = "scientifica";
  static constexpr double kStep = 0.02e-6;        // m: a microstep and a count
  static constexpr double kMotorStep = 0.016e-6;  // m
  static constexpr double kTold = 0.006e-6;       // m: a place is told as whole counts
  static constexpr char kSilence[] = "silence:1.3";
  static constexpr double kStopOnWire = 6 * 10.0 / 38400;  // s
  static constexpr double kRamp = 1 / 0.03;
  static constexpr int kMovesAtMost = 3;
  /// m: a ramp, and what it moves in an exchange.
  static double offUnderWay(double speed) { return 1e-6 + 50e-3 * speed; }
  static std::vector<std::string> faults() {
    return {"drop:1",      "deaf:1",  "deaf:4",        "garble:1",   "garble:3",
            "silence:0.1", "error:3", "interrupt@0.9", "drop:1@0.9", "silence:0.5@0.9"};
  }
};

struct TestedSensapex : TestedMoveByMove<SensapexDriver, SensapexConfig, SensapexEmulator, SensapexEmulatorConfig> {
  static constexpr char kName[] = "sensapex";
  static constexpr double kStep = 0.2e-6;     // m, a count
  static constexpr double kMotorStep = 1e-9;  // m
  static constexpr double kTold = 0.121e-6;   // m: a place is told as whole counts, and kept for 0.6 of one
  static constexpr char kSilence[] = "silence:0.9";
  static constexpr double kStopOnWire = 16 * 10.0 / SensapexConfig::kBaud;  // s
  static constexpr double kSlower = 0.05;
  static constexpr double kMostMoves = 4;  // on its fast line a short move begins as soon as the one before it is over
  static constexpr double kEndIsSeen = 3;  // s: it does not tell that it stands
  static double offUnderWay(double speed) { return 30e-3 * speed; }
  static std::vector<EmulatorConfig> devices() {
    std::vector<EmulatorConfig> all(2);
    all[1].axes = 4;
    all[1].jitter = 10e-9;
    return all;
  }
  static std::vector<std::string> faults() { return TestedEppendorf::faults(); }
};

/// A new driver adds its name here.
using AllTested =
    testing::Types<TestedZaber, TestedMp285, TestedEppendorf, TestedTransferman, TestedScientifica, TestedSensapex>;
using AllMoveByMove =
    testing::Types<TestedMp285, TestedEppendorf, TestedTransferman, TestedScientifica, TestedSensapex>;
struct Names {
  template <typename Tested>
  static std::string GetName(int) {
    return Tested::kName;
  }
};

/// A driver on an emulated wire, and where its device truly is.
template <typename Tested>
class DriverTest : public testing::Test {
 protected:
  using State = ManipulatorDevice::State;
  static constexpr double kStep = Tested::kStep;

  /// With the truth in the joints' order.
  struct Rig : EmulatedRig<typename Tested::Driver, typename Tested::Config> {
    using EmulatedRig<typename Tested::Driver, typename Tested::Config>::EmulatedRig;
    Eigen::Vector3d place() {
      return Tested::config().joints.toJoints(Tested::inJointOrder(this->device().position()));
    }
  };

  void make(const typename Tested::EmulatorConfig& device = {},
            const typename Tested::Config& driver = Tested::config()) {
    rig_ = std::make_unique<Rig>(driver, std::make_shared<typename Tested::Emulator>(device));
  }
  void start() {
    if (!rig_) make();
    ASSERT_TRUE(rig_->runUntilReady());
    expectNear(rig_->read(), rig_->place(), Tested::kTold);
  }
  void moveAndCheck(const Eigen::Vector3d& place = kPlace) {
    rig_->driver().moveTo(place, 1e-3);
    ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().reason();
    expectNear(rig_->place(), place, kStep);
    expectNear(rig_->read(), rig_->place(), Tested::kTold);
  }

  std::unique_ptr<Rig> rig_;
};

}  // namespace microinjection
