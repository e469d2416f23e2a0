#pragma once

#include <memory>
#include <string>

#include "rig/serial/emulated_line.h"
#include "rig/serial/pseudo_terminal.h"

namespace microinjection {

/// An emulated device on a pseudo-terminal, for drivers in other programs: step it often, with the real time.
class EmulatorHost {
 public:
  /// `link`: path at which the driver finds it; `baud` in bit/s. @throws ConfigError when the link cannot be made.
  EmulatorHost(std::shared_ptr<DeviceEmulator> device, double baud, const std::string& link)
      : line_(std::move(device), baud), terminal_(link) {}

  struct Exchange {
    std::string heard, said;  ///< bytes since the last step, as they entered the line and as they left it
  };
  /// `time` in s, never goes back.
  Exchange step(double time) {
    Exchange exchange;
    exchange.heard = terminal_.read();
    line_.send(exchange.heard, time);
    exchange.said = line_.receive(time);
    terminal_.write(exchange.said);
    return exchange;
  }
  void pull() { terminal_.unplug(), line_.cut(); }  ///< the cable
  void plug() { terminal_.plug(); }

 private:
  EmulatedLine line_;
  PseudoTerminal terminal_;
};

}  // namespace microinjection
