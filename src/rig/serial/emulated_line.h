#pragma once

#include <memory>
#include <string>

#include "rig/serial/emulator.h"
#include "rig/serial/line_timing.h"

namespace microinjection {

/// An emulated device at the end of a line that takes its time, in virtual time (s) that never goes back.
class EmulatedLine {
 public:
  /// `held` (s): what the device says arrives later by that, as through a USB adapter with a latency timer.
  EmulatedLine(std::shared_ptr<DeviceEmulator> device, double baud, double held = 0);

  void send(const std::string& bytes, double time) { to_device_.put(bytes, time); }
  /// Lets time pass and returns what has arrived from the device.
  std::string receive(double time);
  /// Everything on its way is lost, and what the device says from now until `time` of the next call, too.
  void cut();

 private:
  std::shared_ptr<DeviceEmulator> device_;
  LineTiming to_device_, from_device_;
  double held_;  // s
  bool was_cut_ = false;
};

}  // namespace microinjection
