#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hardware/serial/wire.h"

namespace microinjection {

/// The line of a motion card, which talks at 9600 or 38400 baud, and falls back to 9600 baud when it
/// is switched off and on (acq4 tries both as well). A line without a reply that can be read is
/// closed, and opened at the other rate; a reason tells both.
class ScientificaWire : public Wire {
 public:
  using Open = std::function<std::unique_ptr<Wire>(int baud)>;  ///< makes the wire, not open yet

  ScientificaWire(int baud, Open make) : baud_(baud), make_(std::move(make)) {}

  void setGuardedStop(const std::string& bytes) override;
  GuardReport heartbeat() override { return wire_ ? wire_->heartbeat() : GuardReport{}; }
  std::string open() override;
  bool isOpen() const override { return wire_ && wire_->isOpen(); }
  std::string read(double time) override;
  void write(const std::string& bytes, double time) override;

  int baud() const { return baud_; }  ///< bit/s, of this try

 private:
  int baud_;
  Open make_;
  std::string guarded_stop_;
  std::unique_ptr<Wire> wire_;  // null: closed
  std::string line_;            // the beginning of a reply
  double asked_ = -1;           // s, of the first request without a reply; -1: there is none
  std::string refused_;         // why the line was closed; told by the next open()
};

}  // namespace microinjection
