#include "rig/devices/rig_registry.h"

#include "base/errors.h"
#include "rig/devices/eppendorf/eppendorf_driver.h"
#include "rig/devices/eppendorf/eppendorf_emulator.h"
#include "rig/devices/mp285/mp285_driver.h"
#include "rig/devices/mp285/mp285_emulator.h"
#include "rig/devices/scientifica/scientifica_driver.h"
#include "rig/devices/scientifica/scientifica_emulator.h"
#include "rig/devices/scientifica/scientifica_wire.h"
#include "rig/devices/sensapex/sensapex_driver.h"
#include "rig/devices/sensapex/sensapex_emulator.h"
#include "rig/devices/zaber/zaber_driver.h"
#include "rig/devices/zaber/zaber_emulator.h"
#include "rig/serial/udp_wire.h"

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
Rig rig(const std::string& name, int default_baud) {
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

const std::vector<Rig>& rigs() {
  static const std::vector<Rig> all{
      rig<EppendorfConfig, EppendorfDriver, EppendorfEmulator>("eppendorf", 19200),
      rig<Mp285Config, Mp285Driver, Mp285Emulator>("mp285", 9600),
      rig<ScientificaConfig, ScientificaDriver, ScientificaEmulator>("scientifica", 38400),
      rig<SensapexConfig, SensapexDriver, SensapexEmulator>("sensapex", SensapexConfig::kBaud),
      rig<EppendorfConfig, EppendorfDriver, TransfermanEmulator>("transferman", 19200),
      rig<ZaberConfig, ZaberDriver, ZaberEmulator>("zaber", 115200),
  };
  return all;
}

const Rig& findRig(const std::string& name) {
  std::string names;
  for (const Rig& rig : rigs()) {
    if (rig.name == name) return rig;
    names += (names.empty() ? "" : ", ") + rig.name;
  }
  throw ConfigError("rig = " + name + ": must be one of: " + names);
}

}  // namespace microinjection
