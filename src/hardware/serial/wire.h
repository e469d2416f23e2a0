#pragma once

#include <string>

namespace microinjection {

/// A byte stream to a device, as its driver uses it. No function blocks, since a driver is stepped at its node's
/// rate.
///
///     driver --> Wire --+--> SerialPort     a serial line or pseudo-terminal --+--> device
///                       +--> UdpWire        datagrams -------------------------'    (a stop guard holds the line, too)
///                       '--> EmulatedWire   an emulator, in the driver's own time
///
/// A driver could use the port directly. Behind this interface it runs unchanged against an emulator in the same
/// process, byte for byte at the line's speed, and a test of a lost reply or a pulled cable takes no real time and is
/// the same in every run.
///
/// The stop guard belongs to the wire and not to the driver. Only a process of its own can stop the device of a
/// program that was killed or is frozen, and only the wire can hand the open line to it; a driver just names the
/// bytes that stop its device.
class Wire {
 public:
  virtual ~Wire() = default;

  /// Sets the bytes that stop the device. From now on, or from the next open() on, a guard sends them
  /// when this program dies without closing the line, or when heartbeat() is not called for 0.2 s.
  /// Without bytes the line needs no guard; they are taken back on a closed line only.
  virtual void setGuardedStop(const std::string& /*bytes*/) {}

  /// For a device that may not hear a stop in the middle of a command: s between two stops, of which
  /// the guard then sends a second one also when this program dies.
  virtual void setStopsApart(double /*apart*/) {}
  /// Closes the line as a death of this program does: the guard sends its stops.
  virtual void leaveToGuard() {}

  struct GuardReport {
    std::string intervention;  ///< why the device was or must be stopped since the last heartbeat; no reply is pending
    std::string missing;  ///< why there is no guard, so that nothing may move; empty: there is one, or none is needed
  };
  /// Signals the guard that this program is running. Must be called in every step.
  virtual GuardReport heartbeat() { return {}; }

  /// Opens the line, or reopens it after a failure. Returns an empty text if it is open, otherwise
  /// the reason.
  virtual std::string open() = 0;
  virtual bool isOpen() const = 0;  ///< false before open(), and after the line broke

  /// Bytes received since the last call, possibly none. A broken line closes itself. `time` in s.
  virtual std::string read(double time) = 0;
  /// Queues all bytes for sending, or closes the line if that fails. `time` in s. After an intervention of the guard
  /// only the stop is sent, until heartbeat() has reported the intervention. Without an open line nothing is sent.
  virtual void write(const std::string& bytes, double time) = 0;
};

}  // namespace microinjection
