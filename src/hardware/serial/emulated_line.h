#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "hardware/serial/emulator.h"

namespace microinjection {

/// One direction of a serial line in virtual time: each byte takes 10 bit times (start bit, 8 data
/// bits, stop bit).
class LineTiming {
 public:
  struct Byte {
    char value;
    double time;  ///< s, when its last bit has arrived
  };

  /// `baud` in bit/s, > 0.
  explicit LineTiming(double baud) : byte_time_(10 / baud) {}

  /// Sends bytes from `time` (s), after those that are still being sent.
  void put(const std::string& bytes, double time);
  /// Removes and returns the bytes that have arrived by `time` (s), in order.
  std::vector<Byte> receive(double time);
  void clear() { bytes_.clear(); }

 private:
  double byte_time_;  // s
  double free_ = 0;   // s, when the last byte has been sent
  std::deque<Byte> bytes_;
};

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
