#include "rig/injector/injector_protocol.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/parse_number.h"
#include "rig/injector/protocol_placeholders.h"

namespace microinjection {
namespace {

constexpr double kDigits = 0.1;  // largest relative error by the limited digits of a line

bool near(double value, double wanted, double share) { return std::abs(value - wanted) <= share * std::abs(wanted); }

/// `value` as written by the first line with one of the placeholders; empty: no line has one.
std::optional<double> asWritten(const InjectorProtocol::Exchanges& exchanges,
                                const std::vector<Placeholder>& placeholders, double value) {
  for (const auto& exchange : exchanges) {
    for (const Placeholder& placeholder : placeholders) {
      if (!exchange.send.has(placeholder.name)) continue;
      return exchange.send.rounded(placeholder.name, placeholder.toUnit(value)) * placeholder.unit + placeholder.zero;
    }
  }
  return std::nullopt;
}

std::string tooCoarse(const std::string& what, double requested, double sent, const std::string& unit) {
  if (near(sent, requested, kDigits)) return "";
  std::ostringstream out;
  out << what << " = " << requested << ' ' << unit << ": the digits of the device's line make it " << sent << ' '
      << unit;
  return out.str();
}

std::string tooLarge(const std::string& what, double sent, double unit, double zero, double largest) {
  const double number = (sent - zero) / unit;
  if (number <= largest + 1e-6) return "";
  std::ostringstream out;
  out << what << " = " << sent << " Pa: " << number << " in the device's line, at most " << largest;
  return out.str();
}

std::string other(const std::string& what, double requested, double set, const std::string& unit) {
  if (near(requested, set, 1e-6)) return "";
  std::ostringstream out;
  out << what << " = " << requested << ' ' << unit << ": set by hand at the device, must be " << set << ' ' << unit;
  return out.str();
}

}  // namespace

InjectionPulse InjectorProtocol::asSent(const InjectionPulse& requested) const {
  InjectionPulse sent = requested;
  const auto pressure = asWritten(pulse, pressurePlaceholders(pressure_unit, pressure_zero), requested.pressure);
  const auto duration = asWritten(pulse, durationPlaceholders(), requested.duration);
  sent.pressure = pressure.value_or(pulse_pressure.value_or(requested.pressure));
  sent.duration = timed ? requested.duration : duration.value_or(pulse_duration.value_or(requested.duration));
  return sent;
}

double InjectorProtocol::balanceAsSent(double pressure) const {
  return asWritten(balance, pressurePlaceholders(pressure_unit, pressure_zero), pressure).value_or(pressure);
}

std::string InjectorProtocol::refusal(const InjectionPulse& requested) const {
  if (pulse_pressure) {
    const std::string set = other("pulse pressure", requested.pressure, *pulse_pressure, "Pa");
    if (!set.empty()) return set;
  }
  if (pulse_duration) {
    const std::string set = other("pulse duration", requested.duration, *pulse_duration, "s");
    if (!set.empty()) return set;
  }
  if (timed && requested.duration < stop_latency) {
    std::ostringstream out;
    out << "pulse duration = " << requested.duration << " s: shorter than the device's stop_latency, " << stop_latency
        << " s";
    return out.str();
  }
  const InjectionPulse sent = asSent(requested);
  std::string coarse = tooCoarse("pulse pressure", requested.pressure, sent.pressure, "Pa");
  if (coarse.empty()) coarse = tooLarge("pulse pressure", sent.pressure, pressure_unit, pressure_zero, largest);
  return coarse.empty() ? tooCoarse("pulse duration", requested.duration, sent.duration, "s") : coarse;
}

std::string InjectorProtocol::balanceRefusal(double pressure) const {
  if (balance.empty()) return "the device's balance pressure is set by hand: its protocol has no line for it";
  const double sent = balanceAsSent(pressure);
  const std::string coarse = tooCoarse("balance pressure", pressure, sent, "Pa");
  return coarse.empty() ? tooLarge("balance pressure", sent, pressure_unit, pressure_zero, largest) : coarse;
}

InjectorProtocol::Values InjectorProtocol::pulseValues(const InjectionPulse& requested) const {
  Values values = balanceValues(requested.pressure);
  for (const Placeholder& placeholder : durationPlaceholders())
    values[placeholder.name] = placeholder.toUnit(requested.duration);
  return values;
}

InjectorProtocol::Values InjectorProtocol::balanceValues(double pressure) const {
  Values values;
  for (const Placeholder& placeholder : pressurePlaceholders(pressure_unit, pressure_zero))
    values[placeholder.name] = placeholder.toUnit(pressure);
  values[kCount] = 0;
  return values;
}

std::string InjectorProtocol::misread(const Exchange& exchange, const std::smatch& groups, const Values& values) {
  if (exchange.confirm.empty()) return "";
  if (exchange.confirm == kLine) {
    const std::string line = exchange.send.fill(values);
    return groups[1].str() == line ? "" : "it has understood " + groups[1].str() + " instead of " + line;
  }
  const double wanted = values.at(exchange.confirm);
  const auto read = parseNumber<double>(groups[1].str());
  if (read && std::abs(*read - wanted) <= 1e-6 * std::max(1.0, std::abs(wanted))) return "";
  std::ostringstream out;
  out << "it reads back " << groups[1].str() << " instead of " << wanted;
  return out.str();
}

std::optional<double> InjectorProtocol::duration(const Exchange& exchange, const std::smatch& groups) {
  for (const Placeholder& placeholder : durationPlaceholders()) {
    if (placeholder.name != exchange.confirm || groups.size() < 2) continue;
    if (const auto read = parseNumber<double>(groups[1].str())) return *read * placeholder.unit;
  }
  return std::nullopt;
}

std::optional<double> InjectorProtocol::queriedPressure(const std::smatch& groups) const {
  const auto read = parseNumber<double>(groups[1].str());
  if (!read) return std::nullopt;
  return *read * pressure_unit + pressure_zero;
}

double InjectorProtocol::totalTimeout(const Exchanges& exchanges) {
  double sum = 0;
  for (const Exchange& exchange : exchanges) sum += exchange.timeout;
  return sum;
}

}  // namespace microinjection
