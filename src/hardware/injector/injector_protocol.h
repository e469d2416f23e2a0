#pragma once

#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "hardware/injector/injector_device.h"
#include "hardware/injector/line_dialogue.h"
#include "hardware/injector/line_template.h"

namespace microinjection {

/// Protocol of a real injector on a serial line: the lines for each command and the expected
/// replies.
///
/// A command is a list of exchanges, each a line and its reply. The next line is sent when the
/// reply to the previous one is as expected. The last line of `pulse` triggers the pulse; the lines
/// before it only set it up. `verify` follows a pulse: if somebody has turned a knob meanwhile, what
/// the pulse has injected is unknown.
///
/// Placeholders for numbers in a line: {pressure_Pa}, {pressure_hPa}, {pressure_kPa},
/// {pressure_psi}, and {pressure} in the device's own unit (`pressure_unit`, `pressure_zero`); in
/// `pulse` and `verify` also {duration_s} and {duration_ms}. In these they have the pulse's values,
/// elsewhere the balance pressure. {count} is a digit or letter, another one in each line.
/// Placeholders for data that only the user has, such as the unpublished number of a command: {NAME},
/// or {NAME:LENGTH}, from codes/NAME. Regular expressions (ECMAScript) must match a whole reply.
class InjectorProtocol {
 public:
  using Values = std::map<std::string, double>;  ///< numbers by the names of their placeholders

  struct Exchange {
    LineTemplate send;
    std::regex expect;
    std::string confirm;   ///< what the first group of `expect` must be: the number of this name, or the `line`
                           ///< as sent; empty: none
    double timeout = 0.5;  ///< s, for the reply
  };
  using Exchanges = std::vector<Exchange>;

  static InjectorProtocol read(ConfigReader& reader);

  LineDialogue::Framing framing;
  Exchanges begin;            ///< sent after the line was opened; a refusal is ignored
  Exchanges pulse;            ///< the last one triggers it
  Exchanges verify;           ///< after a pulse that the device has timed: what it was set to, read again
  Exchanges balance;          ///< empty: the balance pressure is set by hand at the device
  Exchanges stop;             ///< ends a pulse; the first line alone must do so; empty: a pulse cannot be ended
  Exchanges query;            ///< at most one; the first group of `expect`, if any, is the pressure
  double query_period = 0.2;  ///< s
  bool timed = false;         ///< a pulse lasts until `stop`, which is sent when its duration is over
  double stop_latency = 0;    ///< s, from sending `stop` until the device obeys; it is sent so much earlier
  double stop_apart = 0;      ///< s between two stops that the device hears apart, see Wire::setStopsApart(); 0: any
  double pressure_unit = 1;   ///< Pa, of {pressure} and of a queried pressure
  double pressure_zero = 0;   ///< Pa, gauge, at which those are 0
  double largest = 1e9;       ///< number that the device understands for {pressure}
  std::optional<double> pulse_pressure;  ///< Pa, gauge, if no line has a placeholder for it
  std::optional<double> pulse_duration;  ///< s, if no line has a placeholder for it
  std::regex refuse;                     ///< a reply that refuses the command

  /// Returns an empty text, or the reason why the device cannot execute this pulse as commanded.
  std::string refusal(const InjectionPulse& pulse) const;
  std::string balanceRefusal(double pressure) const;
  /// The values as the device receives them, with the limited digits of its lines.
  InjectionPulse asSent(const InjectionPulse& pulse) const;
  double balanceAsSent(double pressure) const;

  Values pulseValues(const InjectionPulse& pulse) const;
  Values balanceValues(double pressure) const;

  /// For an exchange with `confirm`: returns an empty text, or the value that the device reads back
  /// instead of that of `values`, which are as sent.
  static std::string misread(const Exchange& exchange, const std::smatch& groups, const Values& values);
  /// s, that an exchange with `confirm` of a duration reads back; empty for others.
  static std::optional<double> duration(const Exchange& exchange, const std::smatch& groups);
  /// Pa; empty unless the group is a finite number.
  std::optional<double> queriedPressure(const std::smatch& groups) const;
  /// s, sum of the replies' time-outs.
  static double totalTimeout(const Exchanges& exchanges);
};

}  // namespace microinjection
