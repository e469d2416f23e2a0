#pragma once

#include <memory>
#include <string>

#include "hardware/serial/emulated_line.h"
#include "hardware/serial/pseudo_terminal.h"

namespace microinjection {

/// An emulated device on a pseudo-terminal, for drivers in other programs. Must be stepped often,
/// with the real time.
class EmulatorHost {
 public:
  /// `link`: path that the driver opens; `baud` in bit/s. @throws ConfigError if the link cannot be
  /// made.
  EmulatorHost(std::shared_ptr<DeviceEmulator> device, double baud, const std::string& link)
      : line_(std::move(device), baud), terminal_(link) {}

  struct Exchange {
    std::string received, sent;  ///< bytes since the last step, received from and sent to the driver
  };
  /// `time` (s) never decreases.
  Exchange step(double time) {
    Exchange exchange;
    exchange.received = terminal_.read();
    line_.send(exchange.received, time);
    exchange.sent = line_.receive(time);
    terminal_.write(exchange.sent);
    return exchange;
  }
  void disconnectCable() { terminal_.disconnect(), line_.cut(); }
  void connectCable() { terminal_.connect(); }

 private:
  EmulatedLine line_;
  PseudoTerminal terminal_;
};

}  // namespace microinjection
