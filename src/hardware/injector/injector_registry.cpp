#include "hardware/injector/injector_registry.h"

#include "hardware/injector/arduino_emulator.h"
#include "hardware/injector/femtojet_emulator.h"
#include "hardware/injector/output_module_emulator.h"

namespace microinjection {
namespace {

Injector outputModule(const std::string& name, OutputModuleConfig::Kind kind) {
  return {name, 9600, [kind] {
            OutputModuleConfig config;
            config.kind = kind;
            return std::make_shared<OutputModuleEmulator>(config);
          }};
}

}  // namespace

const std::vector<Injector>& injectors() {
  static const std::vector<Injector> all{
      {"arduino", 9600, [] { return std::make_shared<ArduinoEmulator>(); }},
      {"femtojet", 9600, [] { return std::make_shared<FemtojetEmulator>(); }},
      outputModule("relay", OutputModuleConfig::Kind::kRelays),
      outputModule("voltage", OutputModuleConfig::Kind::kVoltage),
  };
  return all;
}

}  // namespace microinjection
