#pragma once

#include <string>

#include "rig/injector/answer_queue.h"
#include "rig/injector/injector_emulator.h"

namespace microinjection {

struct OutputModuleConfig {
  enum class Kind { kRelays, kVoltage };

  Kind kind = Kind::kRelays;
  std::string address = "01";      ///< two hex digits
  double answer_time = 2e-3;       ///< s, from a command's end to its answer's begin
  double supply = 20e3;            ///< Pa, gauge, that the valve behind relay 0 lets through
  double balance = 545;            ///< Pa, gauge, that is there otherwise, set by hand at a regulator
  double pressure_per_volt = 5e3;  ///< Pa/V, of the pressure controller behind the voltage
};

/// An output module that speaks the ASCII protocol of Advantech's ADAM-4000 series (and those who copy it), with a
/// pressure valve or a pressure controller behind it: four relays (ADAM-4060), or 0 to 10 V (ADAM-4021). Written from
/// the series' manual, not from the driver.
///
/// 9600 baud 8N1, every line ends with a carriage return, no checksum (the factory's setting). AA is the address.
/// Relays: "#AA1cDD" sets relay c (DD 00 or 01), "#AA00DD" all of them; "$AA6" is answered "!DD0000" with all of them.
/// Voltage: "#AAvv.vvv" puts it out; "$AA6" is answered "!AAvv.vvv" with the last one that it took.
/// What is obeyed is answered ">", an invalid command "?AA", one with a syntax error or of another address not at all.
///
/// The manual's example reads the number without a sign; its width was taken from there. Nobody has checked on a
/// device. Errors that can be asked for: "?", in answer to the next command, which is then not obeyed. `interrupt`
/// resets the module: its outputs go to 0.
class OutputModuleEmulator : public InjectorEmulator {
 public:
  explicit OutputModuleEmulator(const OutputModuleConfig& config = {}) : config_(config) {}

  double pressure() const override;

 protected:
  void process(const std::string& bytes, double time) override;
  std::string say(double time) override { return answers_.take(time); }
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string&) override { fails_ = true; }
  void interrupt(double) override { relays_ = 0, volts_ = 0; }

 private:
  std::string handleCommand(const std::string& command);
  bool setRelays(const std::string& data);
  bool setVoltage(const std::string& data);
  std::string readBack() const;

  OutputModuleConfig config_;
  std::string command_;  // what has come of it
  bool fails_ = false;
  unsigned relays_ = 0;  // a bit each
  double volts_ = 0;
  AnswerQueue answers_;
};

}  // namespace microinjection
