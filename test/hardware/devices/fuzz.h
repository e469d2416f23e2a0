#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "hardware/devices/damaged_replies.h"
#include "hardware/devices/emulated_rig.h"

namespace microinjection {

constexpr double kFuzzedSpeed = 0.1e-3;  // m/s

/// 200,000 damaged or reordered replies to a driver at work: it must neither crash nor believe a position that is not
/// so, and be in step again as soon as the line is sound.
template <typename Driver, typename Config>
class Fuzz {
  static constexpr int kReplies = 200000;
  static constexpr int kRepliesAtOnce = 2000;  // between two looks whether it is in step
  static constexpr double kStep = 2e-3;        // s
  static constexpr double kRest = 1;           // s at rest after which nothing that is told is carried on from a motion

 public:
  /// `allowed`: how far (m) a place that is told may be off under way, and at rest.
  Fuzz(const Config& config, std::shared_ptr<ManipulatorEmulator> device,
       std::function<std::string(const std::string&, std::mt19937&)> forge, double allowed, double allowed_at_rest,
       double near = 0.05e-6, double told = 1e-9)
      : device_(std::make_shared<DamagedReplies>(std::move(device), 7, std::move(forge))),
        rig_(config, device_, kStep),
        allowed_(allowed),
        allowed_at_rest_(allowed_at_rest),
        near_(near),
        told_(told) {}

  /// Something that befalls the device, at each step (`time` in s); when the line is sound again it must be over.
  void setTrouble(std::function<void(double time, bool disturbs)> trouble) { trouble_ = std::move(trouble); }

  void run(int replies = kReplies) {
    ASSERT_TRUE(rig_.runUntilReady());
    while (device_->damaged() < replies) {
      disturb();
      ASSERT_LE(worst_, allowed_) << "after " << device_->damaged() << " damaged replies, at " << rig_.time() << " s";
      ASSERT_LE(worst_at_rest_, allowed_at_rest_)
          << "after " << device_->damaged() << " damaged replies, at " << rig_.time() << " s";
      ASSERT_NO_FATAL_FAILURE(checkInStep());
    }
    std::printf(
        "%d damaged replies in %.0f s of virtual time; %d messages that were none; furthest off %.1f um, %.3f um at "
        "rest\n",
        device_->damaged(), rig_.time(), rig_.driver().malformed(), 1e6 * worst_, 1e6 * worst_at_rest_);
    EXPECT_GT(judged_at_rest_, replies / 20);
    EXPECT_GT(rig_.driver().malformed(), replies / 10);
  }

 private:
  using State = ManipulatorDevice::State;
  Eigen::Vector3d somewhere() {
    std::uniform_real_distribution<double> place(-50e-6, 50e-6);
    return {place(random_), place(random_), place(random_)};
  }

  void command() {
    switch (std::uniform_int_distribution<int>(0, 999)(random_)) {
      case 0:
        rig_.driver().moveTo(somewhere(), kFuzzedSpeed);
        break;
      case 1:
        rig_.driver().follow(somewhere(), Eigen::Vector3d::Zero());
        break;
      case 2:
        rig_.driver().stop();
        break;
      default:
        break;
    }
    if (rig_.driver().state() == State::kFault) rig_.driver().clearFault();
    if (trouble_) trouble_(rig_.time(), true);
  }

  void disturb() {
    device_->setDamaging(true);
    for (const int end = device_->damaged() + kRepliesAtOnce; device_->damaged() < end;) {
      rig_.run(kStep, [&] { command(); });
      // It may have begun to move and stopped within the step.
      if (rig_.device().moves() || rig_.place() != place_) moved_ = rig_.time();
      place_ = rig_.place();
      const auto reading = rig_.driver().reading();
      if (!reading) continue;
      const double off = (reading->joints - rig_.place()).cwiseAbs().maxCoeff();
      EXPECT_TRUE(reading->joints.allFinite());  // std::max() overlooks NaN
      worst_ = std::max(worst_, off);
      if (rig_.time() - moved_ < kRest) continue;
      worst_at_rest_ = std::max(worst_at_rest_, off);
      ++judged_at_rest_;
    }
    device_->setDamaging(false);
    if (trouble_) trouble_(rig_.time(), false);
  }

  void checkInStep() {
    rig_.driver().stop();
    rig_.run(1);
    rig_.driver().clearFault();
    ASSERT_TRUE(rig_.runUntilReady()) << rig_.driver().reason();
    const Eigen::Vector3d goal = somewhere();
    rig_.driver().moveTo(goal, kFuzzedSpeed);
    ASSERT_TRUE(rig_.runUntilArrived(5)) << rig_.driver().reason();
    expectNear(rig_.place(), goal, near_);
    expectNear(rig_.read(), rig_.place(), told_);
  }

  std::shared_ptr<DamagedReplies> device_;
  EmulatedRig<Driver, Config> rig_;
  std::mt19937 random_{11};
  std::function<void(double, bool)> trouble_;
  double allowed_;  // m
  double allowed_at_rest_;
  double near_, told_;                    // m, of a goal that is reached, and of a place that is told on a sound line
  double worst_ = 0, worst_at_rest_ = 0;  // m, a reading from the truth
  double moved_ = 0;                      // s, when the device did last
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();  // m, in the last step
  int judged_at_rest_ = 0;
};

}  // namespace microinjection
