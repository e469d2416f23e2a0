#pragma once

#include <algorithm>
#include <string>

#include "hardware/injector/injector_emulator.h"
#include "hardware/serial/line_splitter.h"

namespace microinjection {

struct FemtojetEmulatorConfig {
  enum class Echo { kNone, kCommand, kEmptyLine };

  std::string inject = "901";  ///< three digits; invented, since the true command's number is not published
  Echo echo = Echo::kCommand;  ///< what precedes each reply
  std::string line_end = "\r\n";
  double answer_time = 10e-3;  ///< s, from the end of a command to the start of its reply; a guess
  double highest = 600e3;      ///< Pa, gauge, of both pressures
  double longest = 99.9;       ///< s
};

/// Emulates an Eppendorf FemtoJet with RS 232. It is based on the manual and on a public program
/// that controls one, not on the driver.
///
/// From the manual (appendix A of FemtoJet and FemtoJet express): 9600 baud 8N2; "Cxxx=ssssssssss"
/// enters a parameter, "Cxxx" executes a command or reads a parameter, the replies are "Axxx",
/// "Axxx=rrrrrrrrrr" and, to an invalid command, "ERR=eee"; upper and lower case. From the program
/// (AutoInj_GUI): C042, C043 and C044 enter injection time, compensation and injection pressure,
/// C152, C153 and C154 read them, C013 cleans with the highest pressure for so long; commands may
/// end with a line feed; each gets two lines; a number that is read follows a blank.
///
/// Not verified on a device: the content of the first of the two lines (`echo`), the units s and
/// hPa, the limits, the error numbers (001 here) and the reply time. Errors that can be injected:
/// three digits, as the reply to the next command, which is then not executed.
class FemtojetEmulator : public InjectorEmulator {
 public:
  explicit FemtojetEmulator(const FemtojetEmulatorConfig& config = {}) : config_(config) {}

  double pressure() const override {
    return time_ < cleans_until_ ? config_.highest : time_ < injects_until_ ? injection_ : compensation_;
  }

  /// Sets the injection pressure (Pa, gauge) as its knob does.
  void turnInjectionPressure(double pressure) { injection_ = pressure; }

 protected:
  void process(const std::string& bytes, double time) override;
  void advance(double time) override { time_ = std::max(time, time_); }
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override { error_ = code; }
  void interrupt(double time) override { injects_until_ = cleans_until_ = time; }

 private:
  std::string handleCommand(const std::string& line);
  std::string execute(const std::string& number);
  std::string enter(const std::string& number, const std::string& parameter);

  FemtojetEmulatorConfig config_;
  LineSplitter commands_{"\r", 1 << 20};
  std::string error_;                              // for the next command; empty: none
  double injection_time_ = 2;                      // s
  double compensation_ = 2500, injection_ = 10e3;  // Pa
  double injects_until_ = -1, cleans_until_ = -1;  // s
  double time_ = 0;                                // s
};

}  // namespace microinjection
