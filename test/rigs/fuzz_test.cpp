// 100,000 damaged replies a protocol, to a driver at work: it must neither crash nor believe a position that is not so,
// and be in step again as soon as the line is sound.

#include <gtest/gtest.h>

#include "rigs/damaged_replies.h"
#include "rigs/emulated_rig.h"
#include "rigs/mp285/mp285_driver.h"
#include "rigs/mp285/mp285_emulator.h"
#include "rigs/zaber/zaber_driver.h"
#include "rigs/zaber/zaber_emulator.h"

namespace microinjection {
namespace {

using State = ManipulatorDevice::State;
constexpr int kReplies = 100000;
constexpr int kRepliesAtOnce = 2000;  // between two looks whether it is in step
constexpr double kSpeed = 0.1e-3;     // m/s
constexpr double kStep = 2e-3;        // s

template <typename Driver, typename Config>
class Fuzz {
 public:
  Fuzz(const Config& config, std::shared_ptr<ManipulatorEmulator> device,
       std::function<std::string(const std::string&, std::mt19937&)> forge, double allowed)
      : device_(std::make_shared<DamagedReplies>(std::move(device), 7, std::move(forge))),
        rig_(config, device_, kStep),
        allowed_(allowed) {}

  void run() {
    ASSERT_TRUE(rig_.runUntilReady());
    while (device_->damaged() < kReplies) {
      disturb();
      ASSERT_LE(worst_, allowed_) << "after " << device_->damaged() << " damaged replies, at " << rig_.time() << " s";
      ASSERT_NO_FATAL_FAILURE(checkInStep());
    }
    std::printf("%d damaged replies in %.0f s of virtual time; %d messages that were none; furthest off %.1f um\n",
                device_->damaged(), rig_.time(), rig_.driver().malformed(), 1e6 * worst_);
    EXPECT_GT(rig_.driver().malformed(), kReplies / 10);
  }

 private:
  Eigen::Vector3d somewhere() {
    std::uniform_real_distribution<double> place(-50e-6, 50e-6);
    return {place(random_), place(random_), place(random_)};
  }

  void command() {
    switch (std::uniform_int_distribution<int>(0, 999)(random_)) {
      case 0:
        rig_.driver().moveTo(somewhere(), kSpeed);
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
  }

  void disturb() {
    device_->setDamaging(true);
    for (const int end = device_->damaged() + kRepliesAtOnce; device_->damaged() < end;) {
      rig_.run(kStep, [&] { command(); });
      if (const auto reading = rig_.driver().reading()) {
        worst_ = std::max(worst_, (reading->joints - rig_.place()).cwiseAbs().maxCoeff());
      }
    }
    device_->setDamaging(false);
  }

  void checkInStep() {
    rig_.driver().stop();
    rig_.run(1);
    rig_.driver().clearFault();
    ASSERT_TRUE(rig_.runUntilReady()) << rig_.driver().why();
    const Eigen::Vector3d goal = somewhere();
    rig_.driver().moveTo(goal, kSpeed);
    ASSERT_TRUE(rig_.runUntilArrived(5)) << rig_.driver().why();
    expectNear(rig_.place(), goal, 0.05e-6);
    expectNear(rig_.read(), rig_.place(), 1e-9);
  }

  std::shared_ptr<DamagedReplies> device_;
  EmulatedRig<Driver, Config> rig_;
  std::mt19937 random_{11};
  double allowed_;    // m
  double worst_ = 0;  // m, a reading from the truth
};

/// A number in a well-formed reply becomes another one, with the checksum that belongs to it.
std::string forgeZaber(const std::string& reply, std::mt19937& random) {
  const std::size_t at = reply.rfind(' ') + 1, colon = reply.find(':', at);
  std::string text = reply.substr(1, at - 1) + std::to_string(std::uniform_int_distribution<int>(0, 524934)(random));
  if (colon != std::string::npos) {
    int sum = 0;
    for (const char each : text) sum += static_cast<unsigned char>(each);
    char digits[8];
    std::snprintf(digits, sizeof(digits), ":%02X", (256 - sum % 256) % 256);
    text += digits;
  }
  return "@" + text + "\r\n";
}

void fuzzZaber(bool checksum) {
  ZaberConfig config;
  config.joints.origin.setConstant(-12.5e-3);
  config.checksum = config.reply_checksum = checksum;
  config.speed = kSpeed;
  // Between readings: three times a missed answer to a velocity that turns an axis round. Under way a false reading may
  // pass that lies where the axis might be: within the margin and what it moves in the longest guess, 0.2 s.
  const double allowed = 2 * kSpeed * 3 * (config.reply_timeout + 5e-3) + config.reading_margin + kSpeed * 0.2;  // m
  Fuzz<ZaberDriver, ZaberConfig>(config, std::make_shared<ZaberEmulator>(), forgeZaber, allowed).run();
}

TEST(Fuzz, ZaberWithChecksums) { fuzzZaber(true); }
TEST(Fuzz, ZaberWithoutChecksums) { fuzzZaber(false); }

TEST(Fuzz, Mp285) {
  Mp285Config config;
  config.speed = kSpeed;
  config.half_command_time = 0.03;  // s, so that it takes less virtual time
  config.reply_timeout = 0.05;      // s
  Mp285EmulatorConfig device;
  device.half_command_time = 0.025;
  Fuzz<Mp285Driver, Mp285Config> fuzz(
      config, std::make_shared<Mp285Emulator>(device),
      [](const std::string& reply, std::mt19937& random) {
        std::string forged = reply;  // any number, and the right end
        for (std::size_t i = 0; i + 1 < forged.size(); ++i) forged[i] = static_cast<char>(random());
        return forged;
      },
      kSpeed * 0.2);  // it tells of no move but by its end
  fuzz.run();
}

}  // namespace
}  // namespace microinjection
