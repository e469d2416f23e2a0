#include "session/parameter_tree.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

namespace microinjection {
namespace {

constexpr char kQuoted[] = "!";  // the tag that yaml-cpp gives to a scalar in quotes

bool isQuoted(const YAML::Node& scalar) { return scalar.Tag() == kQuoted || scalar.Tag() == "tag:yaml.org,2002:str"; }

/// Of YAML 1.1.
bool isBoolean(const std::string& text) {
  static const std::set<std::string> words = {"yes", "Yes", "YES", "no",    "No",    "NO",    "true", "True", "TRUE",
                                              "on",  "On",  "ON",  "false", "False", "FALSE", "off",  "Off",  "OFF"};
  return words.count(text) > 0;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char each : text) {
    const auto code = static_cast<unsigned char>(each);
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, code < 0x20 || code == 0x7f ? "\\x%02x" : "%c", code);
    result += each == '\n' ? "\\n" : each == '"' ? "\\\"" : each == '\\' ? "\\\\" : escaped;
  }
  return result + '"';
}

/// 56e-6 as 56.0e-6 and 2e5 as 2.0e+5.
std::string withPointAndSign(const std::string& mantissa, const std::string& exponent) {
  std::string text = mantissa;
  if (text.find('.') == std::string::npos) text += ".0";
  if (exponent.empty()) return text;
  const bool has_sign = exponent[1] == '-' || exponent[1] == '+';
  return text + "e" + (has_sign ? "" : "+") + exponent.substr(1);
}

/// A word or path, which is nothing but a text without quotes, too.
bool isPlainWord(const std::string& text) {
  static const std::regex plain("[A-Za-z_/][A-Za-z_0-9/.-]*");
  return std::regex_match(text, plain) && !isBoolean(text) && text != "null" && text != "Null" && text != "NULL";
}

std::string textOf(const std::string& text) { return isPlainWord(text) ? text : quoted(text); }

/// Several lines as they are, such as a URDF.
bool isBlock(const YAML::Node& node) {
  if (!node.IsScalar()) return false;
  const std::string& text = node.Scalar();
  const auto is_control = [](char each) {
    return each != '\n' && (static_cast<unsigned char>(each) < 0x20 || each == 0x7f);
  };
  const bool begins_well = !text.empty() && text.front() != ' ' && text.front() != '\n';
  return begins_well && text.find('\n') != std::string::npos && std::none_of(text.begin(), text.end(), is_control);
}

std::string blockText(const std::string& text, int indent) {
  const bool ends_line = text.back() == '\n', ends_empty = ends_line && text[text.size() - 2] == '\n';
  std::string result = ends_empty ? "|+\n" : ends_line ? "|\n" : "|-\n";
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    result += (line.empty() ? "" : std::string(indent, ' ') + line) + "\n";
  return result;
}

std::string keyText(const std::string& key) {
  static const std::regex plain("[A-Za-z_][A-Za-z_0-9]*");
  return std::regex_match(key, plain) ? textOf(key) : quoted(key);
}

std::string listText(const YAML::Node& list);

/// In one line.
std::string flowText(const YAML::Node& node) {
  if (node.IsSequence()) return listText(node);
  if (!node.IsMap()) return scalarText(node);
  std::string text;
  for (const auto& item : node)
    text += (text.empty() ? "" : ", ") + keyText(item.first.Scalar()) + ": " + flowText(item.second);
  return "{" + text + "}";
}

std::string listText(const YAML::Node& list) {
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i) text += (i == 0 ? "" : ", ") + flowText(list[i]);
  return "[" + text + "]";
}

}  // namespace

YAML::Node emptyMap() { return YAML::Node(YAML::NodeType::Map); }

YAML::Node parameterAt(const YAML::Node& parameters, const std::string& path) {
  YAML::Node node;
  node.reset(parameters);
  std::istringstream keys(path);
  for (std::string key; std::getline(keys, key, '/');) {
    if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    const YAML::Node inner = static_cast<const YAML::Node&>(node)[key];
    if (!inner.IsDefined()) return YAML::Node(YAML::NodeType::Undefined);
    node.reset(inner);
  }
  return node;
}

void setParameter(YAML::Node parameters, const std::string& path, const YAML::Node& value) {
  const std::size_t slash = path.find('/');
  const std::string key = path.substr(0, slash);
  if (slash == std::string::npos) {
    parameters[key] = YAML::Clone(value);
    return;
  }
  if (!parameters[key].IsDefined() || !parameters[key].IsMap()) parameters[key] = YAML::Node(YAML::NodeType::Map);
  setParameter(parameters[key], path.substr(slash + 1), value);
}

void mergeParameters(YAML::Node parameters, const YAML::Node& more) {
  for (const auto& item : more) {
    const std::string key = item.first.Scalar();
    const YAML::Node there = static_cast<const YAML::Node&>(parameters)[key];
    if (item.second.IsMap() && there.IsDefined() && there.IsMap()) {
      mergeParameters(there, item.second);
    } else {
      parameters[key] = YAML::Clone(item.second);
    }
  }
}

YAML::Node textValue(const std::string& value) {
  YAML::Node node(value);
  node.SetTag(kQuoted);
  return node;
}

YAML::Node numberValue(double value) { return YAML::Node(numberText(value)); }

YAML::Node integerValue(int value) { return YAML::Node(std::to_string(value)); }

YAML::Node booleanValue(bool value) { return YAML::Node(value ? "true" : "false"); }

std::string numberText(double value) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  const std::string number = text;
  const std::size_t exponent = number.find('e');
  return exponent == std::string::npos ? withPointAndSign(number, "")
                                       : withPointAndSign(number.substr(0, exponent), number.substr(exponent));
}

std::string scalarText(const YAML::Node& scalar) {
  static const std::regex integer("[-+]?[0-9]+|0x[0-9a-fA-F]+");
  static const std::regex number("([-+]?(?:[0-9]+\\.?[0-9]*|\\.[0-9]+))([eE][-+]?[0-9]+)?");
  static const std::regex not_finite("[-+]?\\.(?:inf|Inf|INF)|\\.(?:nan|NaN|NAN)");
  if (!scalar.IsScalar()) return "null";
  const std::string& text = scalar.Scalar();
  if (isQuoted(scalar)) return textOf(text);
  std::smatch parts;
  if (isBoolean(text) || std::regex_match(text, integer) || std::regex_match(text, not_finite)) return text;
  if (std::regex_match(text, parts, number)) return withPointAndSign(parts[1], parts[2]);
  return textOf(text);
}

std::string parameterText(const YAML::Node& parameters, int indent) {
  std::string text;
  for (const auto& item : parameters) {
    text += std::string(indent, ' ') + keyText(item.first.Scalar()) + ":";
    if (item.second.IsMap() && item.second.size() > 0) {
      text += "\n" + parameterText(item.second, indent + 2);
    } else if (isBlock(item.second)) {
      text += " " + blockText(item.second.Scalar(), indent + 2);
    } else {
      text += " " + flowText(item.second) + "\n";
    }
  }
  return text;
}

std::string shortNumber(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

double roundedParameter(double value) { return std::strtod(shortNumber(value).c_str(), nullptr); }

}  // namespace microinjection
