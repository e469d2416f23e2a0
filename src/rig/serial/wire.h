#pragma once

#include <string>

namespace microinjection {

/// A line of bytes to a device, as its driver sees it. Nothing here waits: a driver is stepped at its node's rate.
class Wire {
 public:
  virtual ~Wire() = default;

  /// Bytes that stop the device. From the next open() on a guard sends them when this program dies without having
  /// closed the line, or when heartbeat() is not called for 0.2 s. None: the line needs no guard.
  virtual void setGuardedStop(const std::string& /*bytes*/) {}

  struct GuardReport {
    std::string intervention;  ///< since the last beat: why the device was stopped or must be; what was asked is void
    std::string missing;       ///< why there is no guard: nothing may move. Empty: there is one, or none is needed
  };
  /// Shows the guard that this program goes on; to be called at every step.
  virtual GuardReport heartbeat() { return {}; }

  /// Opens the line, or tries again after it broke. Empty when it is open, otherwise the reason.
  virtual std::string open() = 0;
  virtual bool isOpen() const = 0;

  /// Bytes that have come since the last call, perhaps none. A broken line closes itself; `time` in s.
  virtual std::string read(double time) = 0;
  /// Hands over all bytes for sending, or closes the line when that fails; `time` in s. After an intervention of the
  /// guard that no heartbeat() has told yet, nothing is sent but the stop.
  virtual void write(const std::string& bytes, double time) = 0;
};

}  // namespace microinjection
