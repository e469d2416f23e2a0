// 200,000 damaged or reordered replies a protocol, to a driver at work: it must neither crash nor believe a position
// that is not so, and be in step again as soon as the line is sound.

#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "rigs/damaged_replies.h"
#include "rigs/emulated_rig.h"
#include "rigs/mp285/mp285_driver.h"
#include "rigs/mp285/mp285_emulator.h"
#include "rigs/zaber/zaber_driver.h"
#include "rigs/zaber/zaber_emulator.h"

namespace microinjection {
namespace {

using State = ManipulatorDevice::State;
constexpr int kRepliesAtOnce = 2000;  // between two looks whether it is in step
constexpr double kSpeed = 0.1e-3;     // m/s
constexpr double kStep = 2e-3;        // s
constexpr double kRest = 1;           // s at rest after which nothing that is told is carried on from a motion

template <typename Driver, typename Config>
class Fuzz {
 public:
  Fuzz(const Config& config, std::shared_ptr<ManipulatorEmulator> device,
       std::function<std::string(const std::string&, std::mt19937&)> forge, double allowed, double allowed_at_rest,
       std::function<void(double time, bool disturbs)> trouble = nullptr)
      : device_(std::make_shared<DamagedReplies>(std::move(device), 7, std::move(forge))),
        rig_(config, device_, kStep),
        allowed_(allowed),
        allowed_at_rest_(allowed_at_rest),
        trouble_(std::move(trouble)) {}

  void run(int replies) {
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
    EXPECT_GT(judged_at_rest_, replies / 10);
    EXPECT_GT(rig_.driver().malformed(), replies / 10);
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
  double allowed_;  // m
  double allowed_at_rest_;
  std::function<void(double, bool)> trouble_;
  double worst_ = 0, worst_at_rest_ = 0;             // m, a reading from the truth
  double moved_ = 0;                                 // s, when the device did last
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();  // m, in the last step
  int judged_at_rest_ = 0;
};

/// A number or now and then a flag in a well-formed reply becomes another one, with the checksum that belongs to it.
std::string forgeZaber(const std::string& reply, std::mt19937& random) {
  static const std::array<std::string, 5> flags{"--", "WT", "WR", "NI", "FS"};
  const std::size_t at = reply.rfind(' ') + 1, colon = reply.find(':', at), flag = reply.find(" -- ");
  std::string text = reply.substr(1, at - 1) + std::to_string(std::uniform_int_distribution<int>(0, 524934)(random));
  if (flag != std::string::npos && std::uniform_int_distribution<int>(0, 29)(random) == 0) {
    text = reply.substr(1, colon == std::string::npos ? reply.size() - 3 : colon - 1);
    text.replace(flag, 2, flags[std::uniform_int_distribution<std::size_t>(0, 4)(random)]);
  }
  if (colon != std::string::npos) {
    int sum = 0;
    for (const char each : text) sum += static_cast<unsigned char>(each);
    char digits[8];
    std::snprintf(digits, sizeof(digits), ":%02X", (256 - sum % 256) % 256);
    text += digits;
  }
  return "@" + text + "\r\n";
}

/// Switches the device off and on now and then, so that it counts from another place, and gives it its reference again
/// some time later, as its maker's tool does.
class Resets {
 public:
  explicit Resets(std::shared_ptr<ZaberEmulator> device) : device_(std::move(device)) {}
  void step(double time, bool disturbs) {
    if (!since_ && disturbs && std::uniform_int_distribution<int>(0, 9999)(random_) == 0) {
      device_->inject(parseFault("error:RESET"));
      since_ = time;
      ++count_;
    } else if (since_ && (!disturbs || time - *since_ > 3)) {
      for (int i = 0; i < 3; ++i) {
        const long long place = std::lround(device_->position()[i] / 0.047625e-6);
        device_->receive("/1 " + std::to_string(i + 1) + " set pos " + std::to_string(place) + "\n", time);
      }
      since_.reset();
    }
  }
  int count() const { return count_; }

 private:
  std::shared_ptr<ZaberEmulator> device_;
  std::mt19937 random_{5};
  std::optional<double> since_;  // s
  int count_ = 0;
};

void fuzzZaber(bool checksum, bool forges) {
  ZaberConfig config;
  config.joints.origin.setConstant(-12.5e-3);
  config.checksum = config.reply_checksum = checksum;
  config.speed = kSpeed;
  // Between readings: three times a missed answer to a velocity that turns an axis round. Under way a false reading may
  // pass that lies where the axis might be: within the margin and what it moves in the longest guess, 0.2 s.
  const double allowed = 2 * kSpeed * 3 * (config.reply_timeout + 5e-3) + config.reading_margin + kSpeed * 0.2;  // m
  // At rest: a microstep or two where a damaged number passes for a true one, nothing where none can.
  const double at_rest = checksum && !forges ? 1e-9 : 2.5 * 0.047625e-6;  // m
  std::function<std::string(const std::string&, std::mt19937&)> forge;
  if (forges) forge = forgeZaber;
  ZaberEmulatorConfig of_device;
  of_device.checksum = checksum;
  of_device.alerts = true;
  const auto device = std::make_shared<ZaberEmulator>(of_device);
  Resets resets(device);
  Fuzz<ZaberDriver, ZaberConfig>(config, device, forge, allowed, at_rest, [&](double time, bool disturbs) {
    resets.step(time, disturbs);
  }).run(70000);
  EXPECT_GT(resets.count(), 10);
}

TEST(Fuzz, ZaberWithChecksums) { fuzzZaber(true, false); }
TEST(Fuzz, ZaberWithForgedChecksums) { fuzzZaber(true, true); }
TEST(Fuzz, ZaberWithoutChecksums) { fuzzZaber(false, true); }

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
      kSpeed * 0.2,  // it tells of no move but by its end
      0.2e-6);       // a low bit turned over passes, again and again: it has no checksum
  fuzz.run(200000);
}

}  // namespace
}  // namespace microinjection
