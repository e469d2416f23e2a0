#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "rigs/emulated_rig.h"
#include "rigs/mp285/mp285_driver.h"
#include "rigs/mp285/mp285_emulator.h"
#include "rigs/zaber/zaber_driver.h"
#include "rigs/zaber/zaber_emulator.h"

namespace microinjection {

const Eigen::Vector3d kPlace(100e-6, -50e-6, 30e-6);  // m

/// What a test of any serial driver must know of one: its driver, its emulator, and how they are set up.
struct TestedZaber {
  using Driver = ZaberDriver;
  using Config = ZaberConfig;
  using Emulator = ZaberEmulator;
  using EmulatorConfig = ZaberEmulatorConfig;
  static constexpr double kStep = 0.047625e-6;   // m, a microstep
  static constexpr double kFastest = 2e-3;       // m/s
  static constexpr double kLongestBlind = 0.16;  // s without an answer that position is still told
  static constexpr char kLostReply[] = "drop:28", kSilence[] = "silence:0.3";
  static constexpr double kStopOnWire = 3 * 10 * 10.0 / 115200;  // s

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
  static constexpr double kFastest = 1e-3;      // m/s
  static constexpr double kLongestBlind = 1.5;  // s, a short move and its failed exchange
  static constexpr char kLostReply[] = "drop:1", kSilence[] = "silence:1.6";
  static constexpr double kStopOnWire = 10.0 / 9600;  // s

  static Config config() {
    Config config;
    config.axes = {2, 0, 1};
    config.joints.directions << 1, -1, 1;
    config.joints.origin << 10e-6, 0, -20e-6;
    return config;
  }
  static Eigen::Vector3d inJointOrder(const Eigen::Vector3d& position) { return config().inJointOrder(position); }
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
    expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
  }
  void moveAndCheck(const Eigen::Vector3d& place = kPlace) {
    rig_->driver().moveTo(place, 1e-3);
    ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().why();
    expectNear(rig_->place(), place, kStep);
    expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
  }

  std::unique_ptr<Rig> rig_;
};

}  // namespace microinjection
