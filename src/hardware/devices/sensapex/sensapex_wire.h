#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hardware/devices/sensapex/sensapex_protocol.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// Lets a driver talk lines with a Sensapex device, which talks datagrams. A line that is written
/// becomes a request, its reply a line that is read:
///
///     STOP                             A
///     POS                              x TAB y TAB z, nm; of four axes a fourth number
///     AXES                             the number of axes
///     GOTO x y z vx vy vz              A; nm, um/s or negative nm/s, the fourth axis rests
///     HELLO                            kept; lost if the device has said since the last WATCH that it
///                                      was started. Both are replied to here
///     WATCH                            kept
///
/// A reply must have the number and the type of the last request; others are late and dropped, as
/// notifications are. "E" is an error, "?" bytes that are no message.
class SensapexWire : public Wire {
 public:
  SensapexWire(std::unique_ptr<Wire> wire, std::uint16_t device);

  void setGuardedStop(const std::string& line) override;
  GuardReport heartbeat() override { return wire_->heartbeat(); }
  std::string open() override { return wire_->open(); }
  bool isOpen() const override { return wire_->isOpen(); }
  std::string read(double time) override;
  void write(const std::string& lines, double time) override;

 private:
  SensapexMessage request(const std::string& line);
  std::string replyTo(const SensapexMessage& message);

  std::unique_ptr<Wire> wire_;
  std::uint16_t device_;
  SensapexParser parser_;
  std::uint16_t number_ = 0;  // of the last request
  std::optional<SensapexMessage> pending_;
  bool started_ = false;  // the device was
  std::string local_;     // replies that are known here
};

}  // namespace microinjection
