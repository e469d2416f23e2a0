#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "manipulator/manipulator_device.h"
#include "rigs/manipulator_emulator.h"
#include "serial/emulated_wire.h"

namespace microinjection {

/// A driver on an emulated wire, stepped at 1 kHz in virtual time.
template <typename Driver, typename Config>
class EmulatedRig {
 public:
  using State = ManipulatorDevice::State;

  EmulatedRig(const Config& config, std::shared_ptr<ManipulatorEmulator> device) : device_(std::move(device)) {
    auto wire = std::make_unique<EmulatedWire>(device_, config.port.baud);
    wire_ = wire.get();
    driver_ = std::make_unique<Driver>(config, std::move(wire));
    joints_ = config.joints;
  }

  Driver& driver() { return *driver_; }
  EmulatedWire& wire() { return *wire_; }
  ManipulatorEmulator& device() { return *device_; }
  double time() const { return time_; }
  void inject(const std::string& fault) { device_->inject(parseFault(fault)); }

  /// Steps for `duration` (s); `each` before every step.
  void run(double duration, const std::function<void()>& each = nullptr) {
    for (double end = time_ + duration; time_ < end - 1e-9;) {
      time_ += 1e-3;
      if (each) each();
      driver_->step(time_);
    }
  }
  /// Steps until `done`, for `longest` (s) at the most; whether it was.
  bool runUntil(const std::function<bool()>& done, double longest) {
    for (const double end = time_ + longest; time_ < end;) {
      run(1e-3);
      if (done()) return true;
    }
    return false;
  }
  bool runUntilReady(double longest = 3) {
    return runUntil([&] { return driver_->state() == State::kReady; }, longest);
  }
  bool runUntilArrived(double longest = 10) {
    run(2e-3);
    return runUntil([&] { return driver_->state() == State::kReady && !driver_->moving(); }, longest);
  }

  Eigen::Vector3d place() const { return joints_.toJoints(device_->position()); }  ///< m, of the joints, in truth
  Eigen::Vector3d read() const { return driver_->reading()->joints; }                ///< m, as the driver says

 private:
  std::shared_ptr<ManipulatorEmulator> device_;
  std::unique_ptr<Driver> driver_;
  EmulatedWire* wire_;
  decltype(Config::joints) joints_;
  double time_ = 0;  // s
};

inline void expectNear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << a.transpose() << " and " << b.transpose();
}

}  // namespace microinjection
