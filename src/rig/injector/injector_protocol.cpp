#include "rig/injector/injector_protocol.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "rig/injector/protocol_places.h"

namespace microinjection {
namespace {

constexpr double kDigits = 0.1;  // share of a number that the digits of a line may take away or add

bool near(double value, double wanted, double share) { return std::abs(value - wanted) <= share * std::abs(wanted); }

/// `value` (in units.size) as the first of the lines with a place for it says it; empty: none has one.
std::optional<double> asWritten(const InjectorProtocol::Exchanges& exchanges, const std::vector<Place>& places,
                                double value) {
  for (const auto& exchange : exchanges) {
    for (const Place& place : places) {
      if (!exchange.send.has(place.name)) continue;
      return exchange.send.rounded(place.name, place.toUnit(value)) * place.unit + place.zero;
    }
  }
  return std::nullopt;
}

std::string tooCoarse(const std::string& what, double asked, double sent, const std::string& unit) {
  if (near(sent, asked, kDigits)) return "";
  std::ostringstream out;
  out << what << " = " << asked << ' ' << unit << ": the digits of the device's line make it " << sent << ' ' << unit;
  return out.str();
}

std::string other(const std::string& what, double asked, double set, const std::string& unit) {
  if (near(asked, set, 1e-6)) return "";
  std::ostringstream out;
  out << what << " = " << asked << ' ' << unit << ": set by hand at the device, must be " << set << ' ' << unit;
  return out.str();
}

std::optional<double> toNumber(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

InjectionPulse InjectorProtocol::asSent(const InjectionPulse& asked) const {
  InjectionPulse sent = asked;
  const auto pressure = asWritten(pulse, pressurePlaces(pressure_unit, pressure_zero), asked.pressure);
  const auto duration = asWritten(pulse, durationPlaces(), asked.duration);
  sent.pressure = pressure.value_or(pulse_pressure.value_or(asked.pressure));
  sent.duration = timed ? asked.duration : duration.value_or(pulse_duration.value_or(asked.duration));
  return sent;
}

double InjectorProtocol::balanceAsSent(double pressure) const {
  return asWritten(balance, pressurePlaces(pressure_unit, pressure_zero), pressure).value_or(pressure);
}

std::string InjectorProtocol::refusal(const InjectionPulse& asked) const {
  if (pulse_pressure) {
    const std::string set = other("pulse pressure", asked.pressure, *pulse_pressure, "Pa");
    if (!set.empty()) return set;
  }
  if (pulse_duration) {
    const std::string set = other("pulse duration", asked.duration, *pulse_duration, "s");
    if (!set.empty()) return set;
  }
  const InjectionPulse sent = asSent(asked);
  const std::string coarse = tooCoarse("pulse pressure", asked.pressure, sent.pressure, "Pa");
  return coarse.empty() ? tooCoarse("pulse duration", asked.duration, sent.duration, "s") : coarse;
}

std::string InjectorProtocol::balanceRefusal(double pressure) const {
  if (balance.empty()) return "the device's balance pressure is set by hand: its protocol has no line for it";
  return tooCoarse("balance pressure", pressure, balanceAsSent(pressure), "Pa");
}

InjectorProtocol::Values InjectorProtocol::pulseValues(const InjectionPulse& asked) const {
  Values values = balanceValues(asked.pressure);
  for (const Place& place : durationPlaces()) values[place.name] = place.toUnit(asked.duration);
  return values;
}

InjectorProtocol::Values InjectorProtocol::balanceValues(double pressure) const {
  Values values;
  for (const Place& place : pressurePlaces(pressure_unit, pressure_zero)) values[place.name] = place.toUnit(pressure);
  return values;
}

std::string InjectorProtocol::misread(const Exchange& exchange, const std::smatch& groups, const Values& values) {
  if (exchange.confirm.empty()) return "";
  const double wanted = values.at(exchange.confirm);
  const auto read = toNumber(groups[1].str());
  if (read && std::abs(*read - wanted) <= 1e-6 * std::max(1.0, std::abs(wanted))) return "";
  std::ostringstream out;
  out << "it reads back " << groups[1].str() << " instead of " << wanted;
  return out.str();
}

std::optional<double> InjectorProtocol::queriedPressure(const std::smatch& groups) const {
  const auto read = toNumber(groups[1].str());
  if (!read) return std::nullopt;
  return *read * pressure_unit + pressure_zero;
}

double InjectorProtocol::patience(const Exchanges& exchanges) {
  double sum = 0;
  for (const Exchange& exchange : exchanges) sum += exchange.timeout;
  return sum;
}

}  // namespace microinjection
