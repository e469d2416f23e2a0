#pragma once

#include <string>

#include "hardware/injector/injector_emulator.h"
#include "hardware/serial/line_splitter.h"

namespace microinjection {

struct OutputModuleConfig {
  enum class Kind { kRelays, kVoltage };

  Kind kind = Kind::kRelays;
  std::string address = "01";      ///< two hex digits
  double answer_time = 2e-3;       ///< s, from the end of a command to the start of its reply
  double supply = 20e3;            ///< Pa, gauge, that the valve at relay 0 passes
  double balance = 545;            ///< Pa, gauge, otherwise, set by hand at a regulator
  double pressure_per_volt = 5e3;  ///< Pa/V, of the pressure controller at the voltage output
};

/// Emulates an output module with the ASCII protocol of Advantech's ADAM-4000 series (and
/// compatible ones), and a pressure valve or pressure controller connected to it: four relays
/// (ADAM-4060), or 0 to 10 V (ADAM-4021). It is based on the series' manual, not on the driver.
///
/// 9600 baud 8N1, every line ends with a carriage return, no checksum (the factory's setting). AA
/// is the address. Relays: "#AA1cDD" sets relay c (DD 00 or 01), "#AA00DD" all of them; the reply
/// to "$AA6" is "!DD0000" with all of them. Voltage: "#AAvv.vvv" sets it; the reply to "$AA6" is
/// "!AAvv.vvv" with the last accepted one. The reply to an executed command is ">", to an invalid
/// one "?AA"; a command with a syntax error or another address gets none.
///
/// The manual's example reads the number without a sign; its width was taken from there. Not
/// verified on a device. Errors that can be injected: "?", as the reply to the next command, which
/// is then not executed. `interrupt` resets the module: its outputs go to 0.
class OutputModuleEmulator : public InjectorEmulator {
 public:
  explicit OutputModuleEmulator(const OutputModuleConfig& config = {}) : config_(config) {}

  double pressure() const override;

 protected:
  void process(const std::string& bytes, double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string&) override { fails_ = true; }
  void interrupt(double) override { relays_ = 0, volts_ = 0; }

 private:
  std::string handleCommand(const std::string& command);
  bool setRelays(const std::string& data);
  bool setVoltage(const std::string& data);
  std::string readBack() const;

  OutputModuleConfig config_;
  LineSplitter commands_{"\r", 1 << 20};
  bool fails_ = false;
  unsigned relays_ = 0;  // one bit each
  double volts_ = 0;
};

}  // namespace microinjection
