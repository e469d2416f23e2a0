#pragma once

#include <string>

namespace microinjection {

/// A line of bytes to a device, as its driver sees it. Nothing here waits: a driver is stepped at its node's rate.
class Wire {
 public:
  virtual ~Wire() = default;

  /// Bytes to be said when this program dies without having closed the line; from the next open() on.
  virtual void setStopWhenKilled(const std::string& /*bytes*/) {}

  /// Opens the line, or tries again after it broke. Empty when it is open, otherwise the reason.
  virtual std::string open() = 0;
  virtual bool isOpen() const = 0;

  /// Bytes that have come since the last call, perhaps none. A broken line closes itself; `time` in s.
  virtual std::string read(double time) = 0;
  /// Hands over all bytes for sending, or closes the line when that fails; `time` in s.
  virtual void write(const std::string& bytes, double time) = 0;
};

}  // namespace microinjection
