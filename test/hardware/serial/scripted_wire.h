#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hardware/serial/wire.h"

namespace microinjection {

/// The test's end of a driver's line. The driver owns the wire; what it says and hears is here.
struct WireScript {
  std::string incoming;           ///< what the driver reads next
  std::vector<std::string> sent;  ///< what it wrote
  std::string refusal;            ///< why the line does not open; empty: it does
  std::string guarded_stop;
  double stops_apart = 0;  ///< s
  bool left_to_guard = false;
  Wire::GuardReport guard;  ///< what the next beat reports
  int beats = 0;
  bool open = false;
  int opened = 0;
};

class ScriptedWire : public Wire {
 public:
  explicit ScriptedWire(WireScript& script) : script_(script) {}
  void setGuardedStop(const std::string& bytes) override { script_.guarded_stop = bytes; }
  void setStopsApart(double apart) override { script_.stops_apart = apart; }
  void leaveToGuard() override { script_.left_to_guard = true; }
  GuardReport heartbeat() override {
    ++script_.beats;
    return {std::exchange(script_.guard.intervention, ""), script_.guard.missing};
  }
  std::string open() override {
    script_.open = script_.refusal.empty();
    script_.opened += script_.open ? 1 : 0;
    return script_.refusal;
  }
  bool isOpen() const override { return script_.open; }
  std::string read(double) override {
    std::string bytes;
    bytes.swap(script_.incoming);
    return bytes;
  }
  void write(const std::string& bytes, double) override { script_.sent.push_back(bytes); }

 private:
  WireScript& script_;
};

}  // namespace microinjection
