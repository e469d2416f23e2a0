#pragma once

#include <string>
#include <vector>

#include "rig/serial/fault.h"

namespace microinjection {

/// A device behind a line of bytes, emulated. Faults of the line are made here, those of the device in the device.
class DeviceEmulator {
 public:
  virtual ~DeviceEmulator() = default;

  /// Hears bytes that have arrived at `time` (s), which never goes back.
  void receive(const std::string& bytes, double time);
  /// Lives on to `time` (s) and returns what it says.
  std::string send(double time);
  /// Has a fault happen at fault.time (s), or at once when that is past.
  /// @throws ConfigError when the device does not know such an error.
  void inject(const Fault& fault);

 protected:
  virtual void process(const std::string& bytes, double time) = 0;
  virtual std::string say(double time) = 0;
  /// An error (its code) for the next command; throws ConfigError when the device does not know it.
  virtual void checkError(const std::string& code) const = 0;
  virtual void failNextCommand(const std::string& code) = 0;
  /// Stops what moves, as the device's own hand wheel or knob does.
  virtual void interrupt(double time) = 0;

 private:
  void beginFaults(double time);

  std::vector<Fault> awaited_;
  double silent_until_ = -1;                       // s
  int to_drop_ = 0, to_miss_ = 0, to_garble_ = 0;  // bytes
};

}  // namespace microinjection
