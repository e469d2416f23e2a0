#pragma once

#include "rig/serial/emulator.h"

namespace microinjection {

/// An emulated injector, which can say what it truly does.
class InjectorEmulator : public DeviceEmulator {
 public:
  /// Pa, gauge, at the pipette, as of the last time that it heard or was asked something.
  virtual double pressure() const = 0;
};

}  // namespace microinjection
