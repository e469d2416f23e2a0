// Damaged replies of devices that go from one move to the next.

#include <cctype>

#include "hardware/devices/eppendorf/eppendorf_driver.h"
#include "hardware/devices/eppendorf/eppendorf_emulator.h"
#include "hardware/devices/fuzz.h"
#include "hardware/devices/mp285/mp285_driver.h"
#include "hardware/devices/mp285/mp285_emulator.h"
#include "hardware/devices/scientifica/scientifica_driver.h"
#include "hardware/devices/scientifica/scientifica_emulator.h"
#include "hardware/devices/sensapex/sensapex_driver.h"
#include "hardware/devices/sensapex/sensapex_emulator.h"

namespace microinjection {
namespace {

TEST(Fuzz, Mp285) {
  Mp285Config config;
  config.speed = kFuzzedSpeed;
  config.half_command_time = 0.03;  // s, so that it takes less virtual time
  config.reply_timeout = 0.05;      // s
  Mp285EmulatorConfig device;
  device.half_command_time = 0.025;
  const auto forge = [](const std::string& reply, std::mt19937& random) {
    std::string forged = reply;  // any number, and the right end
    for (std::size_t i = 0; i + 1 < forged.size(); ++i) forged[i] = static_cast<char>(random());
    return forged;
  };
  // It tells of no move but by its end. At rest: where it was stopped is known to some microsteps until it is read.
  Fuzz<Mp285Driver, Mp285Config>(config, std::make_shared<Mp285Emulator>(device), forge, kFuzzedSpeed * 0.2, 0.1e-6)
      .run();
}

/// Other digits in a reply that is well formed otherwise.
std::string forgeDigits(const std::string& reply, std::mt19937& random) {
  std::string forged = reply;
  for (std::size_t i = forged.find_first_of(" \t"); i < forged.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(forged[i]))) forged[i] = static_cast<char>('0' + random() % 10);
  }
  return forged;
}

/// Under way a false reading may pass that lies where the needle might be: within the margin and 0.1 s of motion.
double allowedUnderWay(const PolledManipulatorConfig& config) {
  return std::sqrt(3.0) * (config.reading_margin + kFuzzedSpeed * 0.1) + kFuzzedSpeed * 0.2;
}

TEST(Fuzz, Eppendorf) {
  EppendorfConfig config;
  config.speed = kFuzzedSpeed;
  config.reply_timeout = 0.05;  // s, so that it takes less virtual time
  // Where it was stopped is known to a count until it is read.
  const double count = 1e-6 + 1e-9, half_a_count = 0.5e-6 + 1e-9;
  Fuzz<EppendorfDriver, EppendorfConfig>(config, std::make_shared<EppendorfEmulator>(), forgeDigits,
                                         allowedUnderWay(config), count, 1.01e-6, half_a_count)
      .run();
}

TEST(Fuzz, Transferman) {
  EppendorfConfig config;
  config.speed = kFuzzedSpeed;
  config.reply_timeout = 0.05;
  config.microsteps_per_metre = 25.6e6;
  const double count = config.count();
  Fuzz<EppendorfDriver, EppendorfConfig>(config, std::make_shared<TransfermanEmulator>(), forgeDigits,
                                         allowedUnderWay(config), 1.01 * count, count, 0.01 * count)
      .run();
}

/// Other numbers in a response: 24 of their 32 bits.
std::string forgeIntegers(const std::string& reply, std::mt19937& random) {
  std::string forged = reply;
  for (std::size_t i = 20; i < forged.size(); ++i) {
    if (i % 4 != 0) forged[i] = static_cast<char>(random());
  }
  return forged;
}

TEST(Fuzz, Sensapex) {
  SensapexConfig config;
  config.speed = kFuzzedSpeed;
  config.reply_timeout = 0.05;
  // Where it was stopped is known to what it moves in an exchange until it is read.
  const double stopped = kFuzzedSpeed * 5e-3, goal = 0.2e-6 + 1e-9, told = 0.121e-6;
  Fuzz<SensapexDriver, SensapexConfig>(config, std::make_shared<SensapexEmulator>(), forgeIntegers,
                                       allowedUnderWay(config), stopped, goal, told)
      .run();
}

TEST(Fuzz, Scientifica) {
  ScientificaConfig config;
  config.speed = kFuzzedSpeed;
  config.reply_timeout = 0.05;  // s
  const double half_a_count = 5e-9 + 1e-12;
  Fuzz<ScientificaDriver, ScientificaConfig>(config, std::make_shared<ScientificaEmulator>(), forgeDigits,
                                             allowedUnderWay(config), half_a_count, 0.05e-6, half_a_count)
      .run();
}

}  // namespace
}  // namespace microinjection
