#include "injector/injector_protocol.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

/// Name of a place and its unit in SI.
struct Unit {
  const char* name;
  double size;
};
constexpr double kPsi = 6894.757293168;  // Pa
constexpr Unit kPressures[] = {
    {"pressure_Pa", 1}, {"pressure_hPa", 100}, {"pressure_kPa", 1000}, {"pressure_psi", kPsi}};
constexpr Unit kDurations[] = {{"duration_s", 1}, {"duration_ms", 1e-3}};

std::vector<std::string> names(bool with_durations) {
  std::vector<std::string> all;
  for (const Unit& unit : kPressures) all.emplace_back(unit.name);
  for (const Unit& unit : kDurations) {
    if (with_durations) all.emplace_back(unit.name);
  }
  return all;
}

void readRegex(ConfigReader& reader, const std::string& key, std::regex& regex) {
  std::string text;
  reader.text(key, text, ConfigReader::kRequired);
  try {
    regex = std::regex(text);
  } catch (const std::regex_error& error) {
    reader.error(key, std::string("is no regular expression: ") + error.what());
  }
}

InjectorProtocol::Exchange readExchange(ConfigReader reader, const std::vector<std::string>& places) {
  InjectorProtocol::Exchange exchange;
  std::string line;
  reader.text("send", line, ConfigReader::kRequired);
  try {
    exchange.send = LineTemplate(line, places);
  } catch (const ConfigError& error) {
    reader.error("send", error.what());
  }
  readRegex(reader, "expect", exchange.expect);
  reader.number("timeout", exchange.timeout, Range::positive());
  return exchange;
}

template <std::size_t n>
void addUnits(const Unit (&units)[n], double value, std::map<std::string, double>& values) {
  for (const Unit& unit : units) values[unit.name] = value / unit.size;
}

template <std::size_t n>
double rounded(const Unit (&units)[n], const LineTemplate& line, double value) {
  for (const Unit& unit : units) {
    const double sent = line.rounded(unit.name, value / unit.size);
    if (sent != value / unit.size) return sent * unit.size;
  }
  return value;
}

}  // namespace

InjectorProtocol InjectorProtocol::read(ConfigReader& reader) {
  InjectorProtocol protocol;
  protocol.pulse = readExchange(reader.section("pulse", ConfigReader::kRequired), names(true));
  protocol.balance = readExchange(reader.section("balance", ConfigReader::kRequired), names(false));
  if (reader.has("stop")) protocol.stop = readExchange(reader.section("stop"), {});
  if (reader.has("query")) {
    protocol.query = readExchange(reader.section("query"), {});
    if (protocol.query->expect.mark_count() < 1) reader.error("query", "expect must have a group for the pressure");
  }
  reader.number("query_period", protocol.query_period, Range::positive());
  reader.number("pressure_unit", protocol.pressure_unit, Range::positive());
  readRegex(reader, "refuse", protocol.refuse);
  reader.text("terminator", protocol.terminator);
  reader.number("quiet", protocol.quiet, Range::nonNegative());
  if (protocol.terminator.empty()) reader.error("terminator", "must not be empty");
  return protocol;
}

std::string InjectorProtocol::pulseLine(const InjectionPulse& asked) const {
  std::map<std::string, double> values;
  addUnits(kPressures, asked.pressure, values);
  addUnits(kDurations, asked.duration, values);
  return pulse.send.fill(values);
}

std::string InjectorProtocol::balanceLine(double pressure) const {
  std::map<std::string, double> values;
  addUnits(kPressures, pressure, values);
  return balance.send.fill(values);
}

InjectionPulse InjectorProtocol::asSent(const InjectionPulse& asked) const {
  return {asked.id, rounded(kPressures, pulse.send, asked.pressure), rounded(kDurations, pulse.send, asked.duration)};
}

std::optional<double> InjectorProtocol::queriedPressure(const std::string& reply) const {
  std::smatch groups;
  if (!query || !std::regex_match(reply, groups, query->expect)) return std::nullopt;
  const std::string text = groups[1].str();
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value * pressure_unit;
}

}  // namespace microinjection
