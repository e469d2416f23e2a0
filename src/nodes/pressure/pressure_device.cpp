#include "nodes/pressure/pressure_device.h"

#include <vector>

#include "base/errors.h"
#include "hardware/injector/injector_registry.h"
#include "hardware/serial/emulated_wire.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

PressureDevice PressureDevice::read(ConfigReader& reader) {
  PressureDevice device;
  reader.choice("source", device.source, {"simulated", "serial"});
  if (device.isSerial() || reader.has("serial")) {
    ConfigReader serial = reader.section("serial");
    device.port = SerialPortConfig::read(serial, 9600);
    device.protocol = InjectorProtocol::read(serial);
  }
  std::vector<std::string> emulators{"none"};
  for (const Injector& injector : injectors()) emulators.push_back(injector.name);
  reader.choice("emulated", device.emulated, emulators);
  return device;
}

std::unique_ptr<Wire> PressureDevice::makeWire(const Bus& bus) const {
  for (const Injector& injector : injectors()) {
    if (injector.name != emulated) continue;
    return std::make_unique<EmulatedWire>(injector.make_emulator(), port.baud);
  }
  if (bus.isVirtual()) {
    throw ConfigError("source = serial: the injector on " + port.path +
                      " cannot run in virtual time, it injects on while time stands");
  }
  return std::make_unique<SerialPort>(port);
}

std::string pressureStampError(const std_msgs::Header& header, const ros::Time& now, double timeout) {
  if (header.stamp.isZero()) return "its stamp is 0";
  const double age = secondsBetween(header.stamp, now);
  if (age > timeout) return "it is stale";
  return age < -timeout ? "it is from the future" : "";
}

}  // namespace microinjection
