#pragma once

#include <memory>
#include <string>

#include "hardware/serial/emulated_line.h"

namespace microinjection {

/// A client at the end of an emulated device's line: what it is answered, carriage returns and all.
class LineClient {
 public:
  LineClient(std::shared_ptr<DeviceEmulator> device, double baud) : line_(std::move(device), baud) {}

  /// Says something after `pause` (s) and listens for `patience` (s).
  std::string answers(const std::string& command, double patience = 0.2, double pause = 10e-3) {
    std::string said = receive(pause);
    line_.send(command, time_);
    return said + receive(patience);
  }
  std::string receive(double duration) {
    std::string said;
    for (const double end = time_ + duration; time_ < end;) said += line_.receive(time_ += 0.1e-3);
    return said;
  }
  /// Until the first bytes of the answer come.
  std::string firstBytes(const std::string& command) {
    line_.send(command, time_);
    std::string said;
    while (said.empty()) said = line_.receive(time_ += 0.1e-3);
    return said;
  }

 private:
  EmulatedLine line_;
  double time_ = 0;  // s
};

}  // namespace microinjection
