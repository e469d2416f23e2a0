// Damaged replies of a Zaber.

#include "rigs/fuzz.h"
#include "rigs/zaber/zaber_driver.h"
#include "rigs/zaber/zaber_emulator.h"

namespace microinjection {
namespace {

constexpr double kSpeed = 0.1e-3;  // m/s

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
  Fuzz<ZaberDriver, ZaberConfig>(config, std::make_shared<ZaberEmulator>(), forge, allowed, at_rest).run();
}

TEST(Fuzz, ZaberWithChecksums) { fuzzZaber(true, false); }
TEST(Fuzz, ZaberWithForgedChecksums) { fuzzZaber(true, true); }
TEST(Fuzz, ZaberWithoutChecksums) { fuzzZaber(false, true); }

}  // namespace
}  // namespace microinjection
