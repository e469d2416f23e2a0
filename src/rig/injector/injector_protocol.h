#pragma once

#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "rig/injector/injector_device.h"
#include "rig/injector/line_dialogue.h"
#include "rig/injector/line_template.h"

namespace microinjection {

/// How a real injector is talked to over a serial line: what is sent for each command, and what it answers.
///
/// A command is a list of exchanges, a line sent and its reply each; the next line is sent when the reply to the one
/// before is as expected. The last line of `pulse` triggers it: those before it set it up, and inject nothing.
///
/// Places for numbers in a line: {pressure_Pa}, {pressure_hPa}, {pressure_kPa}, {pressure_psi}, and {pressure} in the
/// device's own unit (`pressure_unit`, `pressure_zero`); in `pulse` also {duration_s} and {duration_ms}. In `pulse`
/// they are the pulse's, elsewhere the balance pressure's. Places for what only the user knows, such as a command's
/// number that its maker has not published: {NAME}, or {NAME:LENGTH}, from codes/NAME. Regular expressions (ECMAScript)
/// must match a whole reply.
class InjectorProtocol {
 public:
  using Values = std::map<std::string, double>;  ///< numbers by the names of their places

  struct Exchange {
    LineTemplate send;
    std::regex expect;
    std::string confirm;   ///< name of the number that the first group of `expect` must be; empty: none
    double timeout = 0.5;  ///< s, for the reply
  };
  using Exchanges = std::vector<Exchange>;

  static InjectorProtocol read(ConfigReader& reader);

  LineDialogue::Framing framing;
  Exchanges begin;            ///< first, after the line was opened; a refusal there is passed over
  Exchanges pulse;            ///< the last one triggers it
  Exchanges balance;          ///< none: the device's balance pressure is set by hand
  Exchanges stop;             ///< ends a pulse, back to balance; the first line alone must. None: it cannot be ended
  Exchanges query;            ///< at most one; the first group of `expect`, if there is one, is the pressure
  double query_period = 0.2;  ///< s
  bool timed = false;         ///< a pulse lasts until `stop`, which is sent when its time is over
  double pressure_unit = 1;   ///< Pa, of {pressure} and of a queried pressure
  double pressure_zero = 0;   ///< Pa, gauge, where those are 0
  std::optional<double> pulse_pressure;  ///< Pa, gauge, where no line has a place for it
  std::optional<double> pulse_duration;  ///< s, likewise
  std::regex refuse;                     ///< a reply that says no

  /// Empty, or why the device cannot do this pulse: what it does by its lines is not what was asked for.
  std::string refusal(const InjectionPulse& pulse) const;
  std::string balanceRefusal(double pressure) const;
  /// As the device understands its lines, which have a limited number of digits.
  InjectionPulse asSent(const InjectionPulse& pulse) const;
  double balanceAsSent(double pressure) const;

  Values pulseValues(const InjectionPulse& pulse) const;
  Values balanceValues(double pressure) const;

  /// Of an exchange that confirms: empty, or what the device reads back instead of `values`, which are as sent.
  static std::string misread(const Exchange& exchange, const std::smatch& groups, const Values& values);
  /// Pa; empty unless the group is a finite number.
  std::optional<double> queriedPressure(const std::smatch& groups) const;
  /// s, until all replies have come or are late.
  static double patience(const Exchanges& exchanges);
};

}  // namespace microinjection
