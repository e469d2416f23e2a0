#pragma once

#include <deque>
#include <limits>
#include <string>

#include "hardware/injector/injector_emulator.h"

namespace microinjection {

struct ArduinoEmulatorConfig {
  double pressure_per_count = 200;  ///< Pa, of the pressure controller at pin 11
  double supply = 100e3;            ///< Pa, gauge, behind the high-pressure valve at pin 3
  double byte_time = 30e-3;         ///< s, that the firmware waits before it reads each byte
  double pause = 0.1;               ///< s, after each command
  double vent_time = 0.5;           ///< s, until the low-pressure valve closes
  double boot_time = 1.5;           ///< s, of the boot loader after a reset; a guess
};

/// Emulates an Arduino Uno with the firmware of Autoinjector 2.0 (arduino_pressure_control.ino, and
/// its client arduino_pressure.py, in obria006/Autoinjector_2.0): a pressure controller at a PWM
/// output and two valves. It is based on these, not on the driver.
///
/// 9600 baud 8N1. A command has no terminator: it ends when nothing more has arrived 30 ms after
/// the last byte that was read, so bytes that come too early belong to it, and only its first
/// character decides what it is. The reply comes before the command is executed: "Arduino recieved: "
/// and all that was received. "bc", a number and "C" set the controller to this number (modulo 256)
/// and open its valve; 0 closes it 0.5 s later. What follows the "C" is ignored. "x" cleans with the
/// high pressure for 0.5 s. There are no error replies.
///
/// Not known: the pressure controller, so its pressure per count and its speed. A closed valve is
/// taken to leave no pressure. Error that can be injected: "?" loses the first character of the next
/// command. `interrupt` is a reset: the outputs are off, and the boot loader hears nothing.
class ArduinoEmulator : public InjectorEmulator {
 public:
  explicit ArduinoEmulator(const ArduinoEmulatorConfig& config = {}) : config_(config) {}

  double pressure() const override;

 protected:
  void process(const std::string& bytes, double time) override;
  void advance(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string&) override { loses_first_ = true; }
  void interrupt(double time) override;

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void handleCommand(double time);
  void setPressure(double time);

  ArduinoEmulatorConfig config_;
  std::deque<char> received_;  // and not read yet
  std::string command_;        // read so far
  bool reading_ = false;       // else it waits for a byte
  double next_ = 0;            // s, when it reads the next byte, or looks for one again
  bool loses_first_ = false;
  int pwm_ = 0;                // 0 to 255
  double low_open_until_ = 0;  // s, the low-pressure valve
  double deaf_until_ = 0;      // s, the boot loader
  double purge_ = -kNever;     // s, begin of the last cleaning
  double time_ = 0;            // s
};

}  // namespace microinjection
