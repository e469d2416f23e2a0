#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>

#include "rig/devices/emulated_rig.h"
#include "rig/devices/eppendorf/eppendorf_driver.h"
#include "rig/devices/eppendorf/eppendorf_emulator.h"
#include "rig/devices/mp285/mp285_driver.h"
#include "rig/devices/mp285/mp285_emulator.h"
#include "rig/devices/scientifica/scientifica_driver.h"
#include "rig/devices/scientifica/scientifica_emulator.h"
#include "rig/devices/zaber/zaber_driver.h"
#include "rig/devices/zaber/zaber_emulator.h"

namespace microinjection {

const Eigen::Vector3d kPlace(100e-6, -50e-6, 30e-6);  // m

/// What a test of any serial driver must know of one: its driver, its emulator, and how they are set up.
struct TestedZaber {
  using Driver = ZaberDriver;
  using Config = ZaberConfig;
  using Emulator = ZaberEmulator;
  using EmulatorConfig = ZaberEmulatorConfig;
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

struct TestedMp285 {
  using Driver = Mp285Driver;
  using Config = Mp285Config;
  using Emulator = Mp285Emulator;
  using EmulatorConfig = Mp285EmulatorConfig;
  static constexpr double kStep = 0.04e-6;      // m, a microstep
  static constexpr double kMotorStep = kStep;   // m
  static constexpr double kTold = 0.1 * kStep;  // m, by which a place that is told may be off
  static constexpr double kFastest = 1e-3;      // m/s
  static constexpr double kLongestBlind = 1.5;  // s, a short move and its failed exchange
  static constexpr char kLostReply[] = "drop:1", kSilence[] = "silence:1.1";
  static constexpr double kStopOnWire = 10.0 / 9600;  // s
  static constexpr bool kMovedByHand = true;          // somebody else may move it

  static Config config() {
    Config config;
    config.axes.of_joint = {2, 0, 1};
    config.joints.directions << 1, -1, 1;
    config.joints.origin << 10e-6, 0, -20e-6;
    return config;
  }
  static Eigen::Vector3d inJointOrder(const Eigen::Vector3d& position) { return config().axes.inJointOrder(position); }
};

struct TestedEppendorf {
  using Driver = EppendorfDriver;
  using Config = EppendorfConfig;
  using Emulator = EppendorfEmulator;
  using EmulatorConfig = EppendorfEmulatorConfig;
  static constexpr double kStep = 1e-6;          // m, a count
  static constexpr double kMotorStep = 0.04e-6;  // m
  static constexpr double kTold = 0.5e-6;        // m: a place is told as whole counts
  static constexpr double kFastest = 1e-3;       // m/s
  static constexpr double kLongestBlind = 1.5;   // s
  static constexpr char kLostReply[] = "drop:1", kSilence[] = "silence:1.1";
  static constexpr double kStopOnWire = 7 * 10.0 / 19200;  // s
  static constexpr bool kMovedByHand = false;

  static Config config() {
    Config config;
    config.axes.of_joint = {2, 0, 1};
    config.joints.directions << 1, -1, 1;
    config.joints.origin << 10e-6, 0, -20e-6;
    return config;
  }
  static Eigen::Vector3d inJointOrder(const Eigen::Vector3d& position) { return config().axes.inJointOrder(position); }
};

struct TestedScientifica {
  using Driver = ScientificaDriver;
  using Config = ScientificaConfig;
  using Emulator = ScientificaEmulator;
  using EmulatorConfig = ScientificaEmulatorConfig;
  static constexpr double kStep = 0.02e-6;        // m: a microstep and a count
  static constexpr double kMotorStep = 0.016e-6;  // m
  static constexpr double kTold = 0.006e-6;       // m: a place is told as whole counts
  static constexpr double kFastest = 1e-3;        // m/s
  static constexpr double kLongestBlind = 1.5;    // s
  static constexpr char kLostReply[] = "drop:1", kSilence[] = "silence:1.3";
  static constexpr double kStopOnWire = 6 * 10.0 / 38400;  // s
  static constexpr bool kMovedByHand = true;

  static Config config() {
    Config config;
    config.axes.of_joint = {2, 0, 1};
    config.joints.directions << 1, -1, 1;
    config.joints.origin << 10e-6, 0, -20e-6;
    return config;
  }
  static Eigen::Vector3d inJointOrder(const Eigen::Vector3d& position) { return config().axes.inJointOrder(position); }
};

/// A new driver adds its name here and to Names.
using AllTested = testing::Types<TestedZaber, TestedMp285, TestedEppendorf, TestedScientifica>;
struct Names {
  template <typename Tested>
  static std::string GetName(int) {
    return std::is_same_v<Tested, TestedZaber>       ? "zaber"
           : std::is_same_v<Tested, TestedMp285>     ? "mp285"
           : std::is_same_v<Tested, TestedEppendorf> ? "eppendorf"
                                                     : "scientifica";
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
    ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().why();
    expectNear(rig_->place(), place, kStep);
    expectNear(rig_->read(), rig_->place(), Tested::kTold);
  }

  std::unique_ptr<Rig> rig_;
};

}  // namespace microinjection
