#pragma once

#include <map>
#include <string>
#include <vector>

#include "hardware/serial/fault.h"

namespace microinjection {

/// An emulated device behind a serial line. This class emulates faults of the line; the derived
/// class emulates faults of the device.
class DeviceEmulator {
 public:
  virtual ~DeviceEmulator() = default;

  /// Receives bytes at `time` (s), which never decreases.
  void receive(const std::string& bytes, double time);
  /// Advances to `time` (s) and returns the bytes that the device sends.
  std::string send(double time);
  /// Injects a fault at fault.time (s), or at once if that is past.
  /// @throws ConfigError if the device does not have such an error.
  void inject(const Fault& fault);

 protected:
  virtual void process(const std::string& bytes, double time) = 0;
  /// Advances the device to `time` (s).
  virtual void advance(double /*time*/) {}
  /// Advances to `time` (s). Removes and returns the replies that are due.
  virtual std::string produce(double time);
  /// Sends `bytes` at the time `due` (s), in the order of the calls when it is the same.
  void sendAt(double due, const std::string& bytes) { replies_.emplace(due, bytes); }
  void dropReplies() { replies_.clear(); }
  /// checkError() throws ConfigError for an error code that the device does not have.
  /// failNextCommand() lets the next command fail with this error.
  virtual void checkError(const std::string& code) const = 0;
  virtual void failNextCommand(const std::string& code) = 0;
  /// Stops all motion, as the device's own hand wheel or knob does.
  virtual void interrupt(double time) = 0;

 private:
  void beginFaults(double time);

  std::vector<Fault> pending_;
  std::multimap<double, std::string> replies_;     // by time (s)
  double silent_until_ = -1;                       // s
  int to_drop_ = 0, to_miss_ = 0, to_garble_ = 0;  // bytes
};

}  // namespace microinjection
