#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "hardware/devices/manipulator_emulator.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/serial/emulated_wire.h"

namespace microinjection {

/// A wire to a device that was stopped now and then, together with its driver, and goes on where it was.
class StalledWire : public EmulatedWire {
 public:
  using EmulatedWire::EmulatedWire;
  void stall(double duration) { stalled_ += duration; }
  std::string read(double time) override { return EmulatedWire::read(time - stalled_); }
  void write(const std::string& bytes, double time) override { EmulatedWire::write(bytes, time - stalled_); }

 private:
  double stalled_ = 0;  // s
};

/// A driver on an emulated wire, stepped at 1 kHz (unless told otherwise) in virtual time.
template <typename Driver, typename Config>
class EmulatedRig {
 public:
  using State = ManipulatorDevice::State;

  /// `held` (s): by which all answers come later, as through a slow adapter.
  EmulatedRig(const Config& config, std::shared_ptr<ManipulatorEmulator> device, double step = 1e-3, double held = 0)
      : device_(std::move(device)), step_(step) {
    auto wire = std::make_unique<StalledWire>(device_, config.port.baud, held);
    wire_ = wire.get();
    driver_ = std::make_unique<Driver>(config, std::move(wire));
    joints_ = config.joints;
  }

  Driver& driver() { return *driver_; }
  StalledWire& wire() { return *wire_; }
  ManipulatorEmulator& device() { return *device_; }
  double time() const { return time_; }
  void inject(const std::string& fault) { device_->inject(parseFault(fault)); }

  /// The machine that driver and emulator share does nothing for `duration` (s).
  void stall(double duration) {
    time_ += duration;
    wire_->stall(duration);
  }
  /// The program does nothing for `duration` (s), while the device goes on.
  void standStill(double duration) { time_ += duration; }
  /// Steps for `duration` (s); `each` before every step.
  void run(double duration, const std::function<void()>& each = nullptr) {
    for (double end = time_ + duration; time_ < end - 1e-9;) {
      time_ += step_;
      if (each) each();
      driver_->step(time_);
    }
  }
  /// Steps until `done`, for `longest` (s) at the most; whether it was.
  bool runUntil(const std::function<bool()>& done, double longest) {
    for (const double end = time_ + longest; time_ < end;) {
      run(step_);
      if (done()) return true;
    }
    return false;
  }
  bool runUntilReady(double longest = 3) {
    return runUntil([&] { return driver_->state() == State::kReady; }, longest);
  }
  bool runUntilArrived(double longest = 10) {
    run(2 * step_);
    return runUntil([&] { return driver_->state() == State::kReady && !driver_->moving(); }, longest);
  }

  Eigen::Vector3d place() const { return joints_.toJoints(device_->position()); }  ///< m, of the joints, in truth
  Eigen::Vector3d read() const { return driver_->reading()->joints; }              ///< m, as the driver says

 private:
  std::shared_ptr<ManipulatorEmulator> device_;
  std::unique_ptr<Driver> driver_;
  StalledWire* wire_;
  decltype(Config::joints) joints_;
  double step_;      // s
  double time_ = 0;  // s
};

inline void expectNear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance) {
  EXPECT_TRUE(a.allFinite() && b.allFinite()) << a.transpose() << " and " << b.transpose();
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << a.transpose() << " and " << b.transpose();
}

}  // namespace microinjection
