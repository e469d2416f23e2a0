#pragma once

#include <memory>
#include <string>

#include "hardware/serial/emulated_line.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// A line to an emulated device in the same process, timed in the driver's own time. Every run is
/// the same, whatever the load of the machine.
class EmulatedWire : public Wire {
 public:
  /// `baud` in bit/s; `delay` (s) as in EmulatedLine.
  EmulatedWire(std::shared_ptr<DeviceEmulator> device, double baud, double delay = 0)
      : line_(std::move(device), baud, delay) {}

  std::string open() override;
  bool isOpen() const override { return open_; }
  std::string read(double time) override;
  void write(const std::string& bytes, double time) override;

  void disconnectCable();                           ///< drops the bytes in transit and closes the line
  void connectCable() { cable_connected_ = true; }  ///< allows open() to succeed again

 private:
  EmulatedLine line_;
  bool cable_connected_ = true;
  bool open_ = false;
};

}  // namespace microinjection
