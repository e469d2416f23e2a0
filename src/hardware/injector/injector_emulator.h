#pragma once

#include "hardware/serial/emulator.h"

namespace microinjection {

/// An emulated injector with its true output.
class InjectorEmulator : public DeviceEmulator {
 public:
  /// Pa, gauge, at the pipette, at the last call with a time.
  virtual double pressure() const = 0;
};

}  // namespace microinjection
