#pragma once

#include <string>

#include "rig/injector/answer_queue.h"
#include "rig/injector/injector_emulator.h"

namespace microinjection {

struct FemtojetEmulatorConfig {
  enum class Echo { kNone, kCommand, kEmptyLine };

  std::string inject = "901";  ///< three digits; made up: the number of the true command is not published
  Echo echo = Echo::kCommand;  ///< what comes before each answer
  std::string line_end = "\r\n";
  double answer_time = 10e-3;  ///< s, from a command's end to its answer's begin; a guess
  double highest = 600e3;      ///< Pa, gauge, of both pressures
  double longest = 99.9;       ///< s
};

/// An Eppendorf FemtoJet (the one with RS 232), written from its manual and from a public program that sets one up, not
/// from the driver.
///
/// From the manual (appendix A of FemtoJet and FemtoJet express): 9600 baud 8N2; "Cxxx=ssssssssss" enters a parameter,
/// "Cxxx" executes a command or reads one, the answers are "Axxx", "Axxx=rrrrrrrrrr" and, to what is faulty, "ERR=eee";
/// capital and small letters. From the program (AutoInj_GUI): C042, C043 and C044 enter injection time, compensation
/// and injection pressure, C152, C153 and C154 read them; commands may end with a line feed; two lines come back for
/// each; the number that is read stands behind a blank.
///
/// Nobody has checked on a device: what the first of the two lines is (`echo`), that the units are s and hPa, the
/// limits, the numbers of errors (001 here) and the answer's time.
/// Errors that can be asked for: three digits, in answer to the next command, which is then not obeyed.
class FemtojetEmulator : public InjectorEmulator {
 public:
  explicit FemtojetEmulator(const FemtojetEmulatorConfig& config = {}) : config_(config) {}

  double pressure() const override { return time_ < injects_until_ ? injection_ : compensation_; }

 protected:
  void process(const std::string& bytes, double time) override;
  std::string say(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override { error_ = code; }
  void interrupt(double time) override { injects_until_ = time; }

 private:
  std::string handleCommand(const std::string& line);
  std::string execute(const std::string& number);
  std::string enter(const std::string& number, const std::string& parameter);

  FemtojetEmulatorConfig config_;
  std::string command_;                            // what has come of it
  std::string error_;                              // of the next command; empty: none
  double injection_time_ = 2;                      // s
  double compensation_ = 2500, injection_ = 10e3;  // Pa
  double injects_until_ = -1;                      // s
  double time_ = 0;                                // s
  AnswerQueue answers_;
};

}  // namespace microinjection
