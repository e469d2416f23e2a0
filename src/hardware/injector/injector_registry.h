#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hardware/injector/injector_emulator.h"

namespace microinjection {

/// An injector with a protocol file, config/injectors/NAME.yaml, and an emulator. To add one, add
/// the file, the emulator, and a line in injector_registry.cpp.
struct Injector {
  std::string name;
  int default_baud;  ///< bit/s, as delivered
  std::function<std::shared_ptr<InjectorEmulator>()> make_emulator;
};

const std::vector<Injector>& injectors();

}  // namespace microinjection
