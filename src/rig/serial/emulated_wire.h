#pragma once

#include <memory>
#include <string>

#include "rig/serial/emulated_line.h"
#include "rig/serial/wire.h"

namespace microinjection {

/// A line whose other end is an emulated device in the same process, timed in the driver's own time: the same on every
/// run, however the machine is loaded.
class EmulatedWire : public Wire {
 public:
  /// `baud` in bit/s; `held` (s) as EmulatedLine's.
  EmulatedWire(std::shared_ptr<DeviceEmulator> device, double baud, double held = 0)
      : line_(std::move(device), baud, held) {}

  std::string open() override;
  bool isOpen() const override { return open_; }
  std::string read(double time) override;
  void write(const std::string& bytes, double time) override;

  void pull();                      ///< the cable: what is on its way is lost, and the driver finds the line closed
  void plug() { plugged_ = true; }  ///< the cable again: open() succeeds

 private:
  EmulatedLine line_;
  bool plugged_ = true;
  bool open_ = false;
};

}  // namespace microinjection
