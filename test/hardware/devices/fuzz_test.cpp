// Damaged and reordered replies of a Zaber: 210,000 in three lines, from devices that are switched off and on.

#include <array>
#include <cmath>
#include <optional>

#include "hardware/devices/fuzz.h"
#include "hardware/devices/zaber/zaber_driver.h"
#include "hardware/devices/zaber/zaber_emulator.h"

namespace microinjection {
namespace {

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
  config.speed = kFuzzedSpeed;
  // Between readings: three times a missed answer to a velocity that turns an axis round. Under way a false reading may
  // pass that lies where the axis might be: within the margin and what it moves in the longest guess, 0.2 s.
  const double allowed =
      2 * kFuzzedSpeed * 3 * (config.reply_timeout + 5e-3) + config.reading_margin + kFuzzedSpeed * 0.2;  // m
  // At rest: a microstep or two where a damaged number passes for a true one, nothing where none can.
  const double at_rest = checksum && !forges ? 1e-9 : 2.5 * 0.047625e-6;  // m
  std::function<std::string(const std::string&, std::mt19937&)> forge;
  if (forges) forge = forgeZaber;
  ZaberEmulatorConfig of_device;
  of_device.checksum = checksum;
  of_device.alerts = true;
  const auto device = std::make_shared<ZaberEmulator>(of_device);
  Resets resets(device);
  Fuzz<ZaberDriver, ZaberConfig> fuzz(config, device, forge, allowed, at_rest);
  fuzz.setTrouble([&](double time, bool disturbs) { resets.step(time, disturbs); });
  fuzz.run(70000);  // of 200,000
  EXPECT_GT(resets.count(), 10);
}

TEST(Fuzz, ZaberWithChecksums) { fuzzZaber(true, false); }
TEST(Fuzz, ZaberWithForgedChecksums) { fuzzZaber(true, true); }
TEST(Fuzz, ZaberWithoutChecksums) { fuzzZaber(false, true); }

}  // namespace
}  // namespace microinjection
