#pragma once

#include <memory>
#include <string>

#include "hardware/serial/emulator.h"
#include "hardware/serial/line_timing.h"

namespace microinjection {

/// An emulated device behind a serial line with transmission times. Time (s) is virtual and never
/// decreases.
class EmulatedLine {
 public:
  /// `delay` (s) is added to everything that the device sends, like the latency timer of a USB
  /// adapter.
  EmulatedLine(std::shared_ptr<DeviceEmulator> device, double baud, double delay = 0);

  void send(const std::string& bytes, double time) { to_device_.put(bytes, time); }
  /// Advances to `time` and returns the bytes that have arrived from the device.
  std::string receive(double time);
  /// Drops all bytes in transit, and what the device sends from now until `time` of the next call.
  void cut();

 private:
  std::shared_ptr<DeviceEmulator> device_;
  LineTiming to_device_, from_device_;
  double delay_;  // s
  bool was_cut_ = false;
};

}  // namespace microinjection
