#include "hardware/injector/injector_protocol.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "base/parse_number.h"
#include "hardware/injector/protocol_placeholders.h"
#include "hardware/serial/line_ending.h"

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

using Exchange = InjectorProtocol::Exchange;
using Exchanges = InjectorProtocol::Exchanges;
using Names = std::vector<std::string>;

/// Texts that replace {NAME} in lines and expressions: data of the device that only the user has.
class Codes {
 public:
  explicit Codes(ConfigReader reader) : reader_(std::move(reader)) {}

  /// Replaces the codes in a text. A {NAME} without a code stays; LineTemplate checks it.
  std::string replace(const std::string& text) {
    static const std::regex placeholder("\\{([A-Za-z_]+)(?::([0-9]+))?\\}");
    std::string replaced;
    auto from = text.cbegin();
    for (std::sregex_iterator at(text.cbegin(), text.cend(), placeholder), end; at != end; ++at) {
      const std::smatch& found = *at;
      replaced.append(from, found[0].first);
      from = found[0].second;
      replaced += reader_.has(found[1]) ? read(found[1], found[2]) : found[0].str();
    }
    return replaced.append(from, text.cend());
  }

 private:
  std::string read(const std::string& name, const std::string& length) {
    std::string code;
    reader_.text(name, code);
    const bool plain = std::all_of(code.begin(), code.end(), [](unsigned char c) { return std::isalnum(c); });
    const bool fits = length.empty() ? !code.empty() : std::to_string(code.size()) == length;
    if (plain && fits) return code;
    // Reports a wrong code once, however many lines use it.
    if (std::find(wrong_.begin(), wrong_.end(), name) == wrong_.end()) {
      reader_.error(name, "must be " + (length.empty() ? "" : length + " ") +
                              "letters or digits, in quotes, from your device's manual");
      wrong_.push_back(name);
    }
    return "";
  }

  ConfigReader reader_;
  Names wrong_;
};

std::regex readRegex(ConfigReader& reader, const std::string& key, Codes& codes) {
  std::string text;
  readPlainText(reader, key, text, ConfigReader::kRequired);
  try {
    return std::regex(codes.replace(text));
  } catch (const std::regex_error& error) {
    reader.error(key, std::string("is no regular expression: ") + error.what());
    return {};
  }
}

Exchange readExchange(ConfigReader& reader, Codes& codes, Names placeholders) {
  placeholders.push_back(kCount);
  Exchange exchange;
  std::string line;
  readPlainText(reader, "send", line, ConfigReader::kRequired);
  if (reader.has("send") && line.empty()) reader.error("send", "must not be empty");
  try {
    exchange.send = LineTemplate(codes.replace(line), placeholders);
  } catch (const ConfigError& error) {
    reader.error("send", error.what());
  }
  exchange.expect = readRegex(reader, "expect", codes);
  placeholders.back() = kLine;
  reader.choice("confirm", exchange.confirm, placeholders);
  if (!exchange.confirm.empty() && exchange.expect.mark_count() < 1) {
    reader.error("expect", "must have a group for what is to be confirmed");
  }
  reader.number("timeout", exchange.timeout, Range::positive());
  return exchange;
}

Exchanges readExchanges(ConfigReader& reader, const std::string& key, Codes& codes, const Names& placeholders,
                        ConfigReader::Presence presence = ConfigReader::kOptional) {
  Exchanges exchanges;
  for (ConfigReader& each : reader.sections(key, presence))
    exchanges.push_back(readExchange(each, codes, placeholders));
  if (reader.has(key) && exchanges.empty()) reader.error(key, "must have at least one exchange");
  return exchanges;
}

bool usesPlaceholder(const Exchanges& exchanges, const std::vector<Placeholder>& placeholders) {
  return std::any_of(exchanges.begin(), exchanges.end(), [&](const Exchange& exchange) {
    return std::any_of(placeholders.begin(), placeholders.end(),
                       [&](const Placeholder& placeholder) { return exchange.send.has(placeholder.name); });
  });
}

/// A number without a placeholder is set at the device, so the file must have it.
std::optional<double> readFixed(ConfigReader& reader, const std::string& key, bool in_lines, const Range& range) {
  double value = 0;
  if (in_lines) {
    if (reader.has(key)) reader.error(key, "a line of pulse contains it: omit the key");
    reader.number(key, value);  // marks the key as read
    return std::nullopt;
  }
  reader.number(key, value, range, ConfigReader::kRequired);
  return value;
}

LineDialogue::Framing readFraming(ConfigReader& reader) {
  LineDialogue::Framing framing;
  readLineEnding(reader, "terminator", framing.reply_end);
  framing.send_end = framing.reply_end;
  readLineEnding(reader, "send_terminator", framing.send_end, NoLineEnding::kAllowed);
  reader.boolean("echo", framing.echo);
  reader.number("quiet", framing.quiet, Range::nonNegative());
  return framing;
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

InjectorProtocol InjectorProtocol::read(ConfigReader& reader) {
  InjectorProtocol protocol;
  protocol.framing = readFraming(reader);
  reader.number("pressure_unit", protocol.pressure_unit, Range::positive());
  reader.number("pressure_zero", protocol.pressure_zero);
  reader.number("largest", protocol.largest, Range::positive());
  Codes codes(reader.section("codes"));
  const std::vector<Placeholder> pressures = pressurePlaceholders(protocol.pressure_unit, protocol.pressure_zero);
  const std::vector<Placeholder> durations = durationPlaceholders();
  const Names pressure_names = names(pressures);
  Names all = pressure_names;
  for (const Placeholder& placeholder : durations) all.push_back(placeholder.name);
  protocol.begin = readExchanges(reader, "begin", codes, {});
  protocol.pulse = readExchanges(reader, "pulse", codes, all, ConfigReader::kRequired);
  protocol.verify = readExchanges(reader, "verify", codes, all);
  protocol.balance = readExchanges(reader, "balance", codes, pressure_names);
  protocol.stop = readExchanges(reader, "stop", codes, pressure_names);
  if (reader.has("query")) {
    ConfigReader query = reader.section("query");
    protocol.query.push_back(readExchange(query, codes, pressure_names));
  }
  reader.number("query_period", protocol.query_period, Range::positive());
  reader.boolean("timed", protocol.timed);
  if (protocol.timed && protocol.stop.empty()) reader.error("timed", "needs stop, which ends the pulse");
  if (protocol.timed && !protocol.verify.empty()) reader.error("verify", "must be left out where timed is true");
  reader.number("stop_latency", protocol.stop_latency, Range::nonNegative());
  reader.number("stop_apart", protocol.stop_apart, Range::nonNegative());
  if (reader.has("ignore")) protocol.framing.ignore = readRegex(reader, "ignore", codes);
  protocol.pulse_pressure =
      readFixed(reader, "pulse_pressure", usesPlaceholder(protocol.pulse, pressures), Range::finite());
  protocol.pulse_duration = readFixed(reader, "pulse_duration",
                                      protocol.timed || usesPlaceholder(protocol.pulse, durations), Range::positive());
  protocol.refuse = readRegex(reader, "refuse", codes);
  return protocol;
}

}  // namespace microinjection
