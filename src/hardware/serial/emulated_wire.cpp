#include "hardware/serial/emulated_wire.h"

namespace microinjection {

std::string EmulatedWire::open() {
  if (!cable_connected_) return "emulated line: the cable is pulled";
  open_ = true;
  return "";
}

std::string EmulatedWire::read(double time) { return open_ ? line_.receive(time) : ""; }

void EmulatedWire::write(const std::string& bytes, double time) {
  if (open_) line_.send(bytes, time);
}

void EmulatedWire::disconnectCable() {
  cable_connected_ = false;
  open_ = false;
  line_.cut();
}

}  // namespace microinjection
