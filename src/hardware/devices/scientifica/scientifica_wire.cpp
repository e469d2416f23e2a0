#include "hardware/devices/scientifica/scientifica_wire.h"

#include <utility>

namespace microinjection {
namespace {

constexpr int kAfterPowerOn = 9600, kOtherBaud = 38400;  // bit/s
constexpr double kPatience = 1.5;                        // s, for a reply at this rate; it comes within some ms

}  // namespace

void ScientificaWire::setGuardedStop(const std::string& bytes) {
  guarded_stop_ = bytes;
  if (wire_) wire_->setGuardedStop(bytes);
}

std::string ScientificaWire::open() {
  wire_.reset();
  if (!refused_.empty()) return std::exchange(refused_, "");
  wire_ = make_(baud_);
  wire_->setGuardedStop(guarded_stop_);
  std::string reason = wire_->open();
  if (!reason.empty()) wire_.reset();
  line_.clear();
  asked_ = -1;
  return reason;
}

void ScientificaWire::write(const std::string& bytes, double time) {
  if (!wire_) return;
  if (asked_ < 0) asked_ = time;
  wire_->write(bytes, time);
}

/// A reply at another rate is none of printable characters with a carriage return at its end.
std::string ScientificaWire::read(double time) {
  if (!wire_) return "";
  std::string bytes = wire_->read(time);
  for (const char each : bytes) {
    const bool printable = (each >= ' ' && each <= '~') || each == '\t';
    if (each == '\r' && !line_.empty()) asked_ = -1;
    line_ = printable ? line_ + each : "";
  }
  if (asked_ < 0 || time - asked_ < kPatience) return bytes;
  const int other = baud_ == kAfterPowerOn ? kOtherBaud : kAfterPowerOn;
  refused_ = "Scientifica: no reply at " + std::to_string(baud_) + " baud; trying " + std::to_string(other) +
             " baud (a card has 9600 baud after it was switched on)";
  baud_ = other;
  wire_.reset();
  return bytes;
}

}  // namespace microinjection
