#include "hardware/devices/driver_registry.h"

#include "base/errors.h"
#include "hardware/devices/eppendorf/eppendorf_driver.h"
#include "hardware/devices/eppendorf/eppendorf_emulator.h"
#include "hardware/devices/mp285/mp285_driver.h"
#include "hardware/devices/mp285/mp285_emulator.h"
#include "hardware/devices/scientifica/scientifica_driver.h"
#include "hardware/devices/scientifica/scientifica_emulator.h"
#include "hardware/devices/scientifica/scientifica_wire.h"
#include "hardware/devices/sensapex/sensapex_driver.h"
#include "hardware/devices/sensapex/sensapex_emulator.h"
#include "hardware/devices/zaber/zaber_driver.h"
#include "hardware/devices/zaber/zaber_emulator.h"
#include "hardware/serial/udp_wire.h"

namespace microinjection {
namespace {

template <typename Config>
std::unique_ptr<Wire> wireTo(const Config& config) {
  return makeWire(config.port);
}

std::unique_ptr<Wire> wireTo(const ScientificaConfig& config) {
  return std::make_unique<ScientificaWire>(config.port.baud, [port = config.port](int baud) {
    SerialPortConfig at_rate = port;
    at_rate.baud = baud;
    return makeWire(at_rate);
  });
}

template <typename Config, typename Driver, typename Emulator>
DriverEntry entry(const std::string& name, int default_baud) {
  return {name, default_baud,
          [](ConfigReader& reader, std::unique_ptr<Wire> wire) -> std::unique_ptr<ManipulatorDevice> {
            const Config config = Config::read(reader);
            reader.finish();
            if (!wire) wire = wireTo(config);
            return std::make_unique<Driver>(config, std::move(wire));
          },
          [] { return std::make_shared<Emulator>(); }};
}

}  // namespace

const std::vector<DriverEntry>& driverEntries() {
  static const std::vector<DriverEntry> all{
      entry<EppendorfConfig, EppendorfDriver, EppendorfEmulator>("eppendorf", 19200),
      entry<Mp285Config, Mp285Driver, Mp285Emulator>("mp285", 9600),
      entry<ScientificaConfig, ScientificaDriver, ScientificaEmulator>("scientifica", 38400),
      entry<SensapexConfig, SensapexDriver, SensapexEmulator>("sensapex", SensapexConfig::kBaud),
      entry<EppendorfConfig, EppendorfDriver, TransfermanEmulator>("transferman", 19200),
      entry<ZaberConfig, ZaberDriver, ZaberEmulator>("zaber", 115200),
  };
  return all;
}

const DriverEntry& findDriver(const std::string& name) {
  std::string names;
  for (const DriverEntry& entry : driverEntries()) {
    if (entry.name == name) return entry;
    names += (names.empty() ? "" : ", ") + entry.name;
  }
  throw ConfigError("rig = " + name + ": must be one of: " + names);
}

}  // namespace microinjection
