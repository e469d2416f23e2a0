#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rig/injector/injector_emulator.h"

namespace microinjection {

/// An injector that comes with a file of its line protocol, config/injectors/NAME.yaml, and with an emulator. To add
/// one: the file, the emulator, and a line in injector_registry.cpp.
struct Injector {
  std::string name;
  int default_baud;  ///< bit/s, of the device as delivered
  std::function<std::shared_ptr<InjectorEmulator>()> make_emulator;
};

const std::vector<Injector>& injectors();

}  // namespace microinjection
