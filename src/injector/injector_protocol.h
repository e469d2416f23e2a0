#pragma once

#include <optional>
#include <regex>
#include <string>

#include "base/config_reader.h"
#include "injector/injector_device.h"
#include "injector/line_template.h"

namespace microinjection {

/// How a real injector is talked to over a serial line: what is sent for each command, and what it answers.
///
/// Places in `pulse`: {pressure_Pa}, {pressure_hPa}, {pressure_kPa}, {pressure_psi}, {duration_s}, {duration_ms}; in
/// `balance`: the pressures. Regular expressions (ECMAScript) must match a whole reply.
class InjectorProtocol {
 public:
  struct Exchange {
    LineTemplate send;
    std::regex expect;
    double timeout = 0.5;  ///< s, for the reply
  };

  static InjectorProtocol read(ConfigReader& reader);

  Exchange pulse, balance;
  std::optional<Exchange> stop;   ///< ends a pulse; none: the device cannot, and a pulse goes on to its end
  std::optional<Exchange> query;  ///< of the pressure, the first group of `expect`; none: the device is not asked
  double query_period = 0.2;      ///< s
  double pressure_unit = 1;       ///< Pa, of a queried pressure
  std::regex refuse;              ///< a reply that says no
  std::string terminator = "\r";  ///< of replies
  double quiet = 0.1;             ///< s without a byte, after a reply went wrong, until the line is trusted again

  std::string pulseLine(const InjectionPulse& pulse) const;
  std::string balanceLine(double pressure) const;
  /// The pulse as the device understands its line, which has a limited number of digits.
  InjectionPulse asSent(const InjectionPulse& pulse) const;
  /// Pa; empty unless the reply is as described and finite.
  std::optional<double> queriedPressure(const std::string& reply) const;
};

}  // namespace microinjection
