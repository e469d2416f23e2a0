// Reads an InjectorProtocol.

#include <algorithm>

#include "base/errors.h"
#include "rig/injector/injector_protocol.h"
#include "rig/injector/protocol_placeholders.h"
#include "rig/serial/line_ending.h"

namespace microinjection {
namespace {

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
