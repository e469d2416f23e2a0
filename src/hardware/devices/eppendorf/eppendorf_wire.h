#pragma once

#include <memory>
#include <string>
#include <utility>

#include "hardware/devices/eppendorf/eppendorf_protocol.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// The line of a device that replies to a go-to at its end (C006). That reply comes at any time,
/// also between a request and its reply, and the position tells the same. So it is taken out of
/// what is read; everything else passes unchanged.
class EppendorfWire : public Wire {
 public:
  explicit EppendorfWire(std::unique_ptr<Wire> wire) : wire_(std::move(wire)) {}

  void setGuardedStop(const std::string& bytes) override { wire_->setGuardedStop(bytes); }
  GuardReport heartbeat() override { return wire_->heartbeat(); }
  std::string open() override {
    line_.clear();
    return wire_->open();
  }
  bool isOpen() const override { return wire_->isOpen(); }
  void write(const std::string& bytes, double time) override { wire_->write(bytes, time); }
  std::string read(double time) override {
    std::string passed;
    for (const char each : wire_->read(time)) {
      line_ += each;
      if (mayBeEppendorfMoveEnd(line_)) continue;  // the rest of it decides
      if (!isEppendorfMoveEnd(line_)) passed += line_;
      line_.clear();
    }
    return passed;
  }

 private:
  std::unique_ptr<Wire> wire_;
  std::string line_;  // the beginning of such a reply
};

}  // namespace microinjection
