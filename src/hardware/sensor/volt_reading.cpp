#include "hardware/sensor/volt_reading.h"

#include <cstdio>

#include "base/parse_number.h"
#include "hardware/serial/line_ending.h"
#include "hardware/serial/line_splitter.h"

namespace microinjection {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Parses a plain decimal number with a digit before the point, an optional exponent and
/// surrounding blanks. Library functions also accept "inf", "0x1" and, in some locales, a decimal
/// comma.
std::optional<double> plainNumber(const std::string& field, int decimals) {
  std::size_t at = field.find_first_not_of(' '), end = field.find_last_not_of(' ');
  if (at == std::string::npos) return std::nullopt;
  const std::string text = field.substr(at, end - at + 1);
  at = text[0] == '-' || text[0] == '+' ? 1 : 0;
  const std::size_t whole = at;
  while (at < text.size() && isDigit(text[at])) ++at;
  const bool has_whole = at > whole;
  int behind = 0;
  if (at < text.size() && text[at] == '.') {
    for (++at; at < text.size() && isDigit(text[at]); ++at) ++behind;
  }
  if (!has_whole || (decimals >= 0 && behind != decimals)) return std::nullopt;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    const std::size_t exponent = at;
    while (at < text.size() && isDigit(text[at])) ++at;
    if (at == exponent || at - exponent > 3) return std::nullopt;
  }
  if (at != text.size()) return std::nullopt;
  return parseNumber<double>(text);
}

/// Removes the checksum from the line. Returns false if it is wrong.
bool checkedBody(std::string& line) {
  const std::size_t star = line.rfind('*');
  if (star == std::string::npos || line.size() != star + 3) return false;
  unsigned sum = 0;
  for (std::size_t i = 0; i < star; ++i) sum ^= static_cast<unsigned char>(line[i]);
  char expected[3];
  std::snprintf(expected, sizeof expected, "%02X", sum);
  if (line.compare(star + 1, 2, expected) != 0) return false;
  line.resize(star);
  return true;
}

}  // namespace

VoltReadingConfig VoltReadingConfig::read(ConfigReader& reader) {
  VoltReadingConfig config;
  readPlainText(reader, "separator", config.separator);
  if (config.separator == "TAB") config.separator = "\t";
  readLineEnding(reader, "terminator", config.terminator);
  reader.integer("columns", config.columns, Range::closed(1, 32));
  reader.integer("first", config.first, Range::closed(0, 31));
  reader.integer("voltages", config.voltages, Range::closed(1, 32));
  reader.integer("decimals", config.decimals, Range::closed(-1, 12));
  reader.choice("checksum", config.checksum, {"none", "nmea"});
  reader.vector("voltage_range", config.voltage_range);
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(2 * config.voltages);
  config.offset = Eigen::VectorXd::Zero(config.voltages);
  reader.vector("matrix", rows, Range::finite(), ConfigReader::kRequired);
  reader.vector("offset", config.offset, Range::finite(), ConfigReader::kRequired);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  config.matrix = Eigen::Map<const Rows>(rows.data(), 2, config.voltages);
  if (config.separator.size() != 1) reader.error("separator", "must be one character, or TAB");
  if (config.first + config.voltages > config.columns) reader.error("columns", "must hold all voltages");
  if (config.voltage_range[0] >= config.voltage_range[1]) reader.error("voltage_range", "must be [lowest, highest]");
  return config;
}

std::optional<Eigen::VectorXd> parseVoltages(const std::string& text, const VoltReadingConfig& config) {
  std::string line = text;
  // If a device ends lines with \r\n and the terminator is \n, the \r remains here.
  if (config.terminator == "\n" && !line.empty() && line.back() == '\r') line.pop_back();
  if (config.checksum == "nmea" && !checkedBody(line)) return std::nullopt;
  const auto fields = LineSplitter(config.separator, line.size()).feed(line + config.separator);
  if (static_cast<int>(fields.size()) != config.columns) return std::nullopt;
  Eigen::VectorXd voltages(config.voltages);
  for (int i = 0; i < config.voltages; ++i) {
    const auto value = plainNumber(fields[config.first + i], config.decimals);
    if (!value || *value < config.voltage_range[0] || *value > config.voltage_range[1]) return std::nullopt;
    voltages[i] = *value;
  }
  return voltages;
}

Eigen::Vector2d forceOfVoltages(const Eigen::VectorXd& voltages, const VoltReadingConfig& config) {
  return config.matrix * (voltages - config.offset);
}

}  // namespace microinjection
