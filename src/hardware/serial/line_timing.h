#pragma once

#include <deque>
#include <string>
#include <vector>

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

}  // namespace microinjection
