#include "base/config_reader.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "base/errors.h"

namespace microinjection {

namespace {

/// Replaces control characters by their codes. A carriage return would hide the text before it on a
/// terminal.
std::string visible(const std::string& text) {
  std::string shown;
  for (const char each : text) {
    const auto code = static_cast<unsigned char>(each);
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, code < 0x20 || code == 0x7f ? "\\x%02x" : "%c", code);
    shown += escaped;
  }
  return shown;
}

}  // namespace

struct ConfigReader::Level {
  YAML::Node map;
  std::string path;  ///< "" or "cell/material/"
  std::set<std::string> known;
};

ConfigReader::ConfigReader(const YAML::Node& map, const std::string& origin)
    : ConfigReader(map, origin, "", std::make_shared<std::vector<std::string>>(),
                   std::make_shared<std::vector<std::shared_ptr<Level>>>()) {}

ConfigReader::ConfigReader(const YAML::Node& map, const std::string& origin, const std::string& path,
                           std::shared_ptr<std::vector<std::string>> errors,
                           std::shared_ptr<std::vector<std::shared_ptr<Level>>> levels)
    : origin_(origin), errors_(std::move(errors)), levels_(std::move(levels)), level_(std::make_shared<Level>()) {
  level_->map.reset(map);
  level_->path = path;
  levels_->push_back(level_);
}

bool ConfigReader::has(const std::string& key) const {
  const YAML::Node& map = level_->map;
  return map.IsMap() && map[key].IsDefined();
}

const YAML::Node ConfigReader::find(const std::string& key, Presence presence) {
  level_->known.insert(key);
  if (has(key)) return static_cast<const YAML::Node&>(level_->map)[key];
  if (presence == kRequired) errors_->push_back(origin_ + ": " + level_->path + key + " is missing");
  return YAML::Node(YAML::NodeType::Undefined);
}

std::string ConfigReader::valueText(const std::string& key) const {
  if (!has(key)) return "";
  YAML::Emitter out;
  out << YAML::Flow << static_cast<const YAML::Node&>(level_->map)[key];
  return std::string(" = ") + visible(out.c_str());
}

void ConfigReader::error(const std::string& key, const std::string& message) {
  errors_->push_back(origin_ + ": " + level_->path + key + valueText(key) + ": " + message);
}

void ConfigReader::number(const std::string& key, double& value, const Range& range, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  double read = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, read)) return error(key, "must be a number");
  if (!range.contains(read)) return error(key, "must be a number in " + range.text());
  value = read;
}

void ConfigReader::integer(const std::string& key, int& value, const Range& range, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  int read = 0;
  if (!node.IsScalar() || !YAML::convert<int>::decode(node, read)) return error(key, "must be an integer");
  if (!range.contains(read)) return error(key, "must be an integer in " + range.text());
  value = read;
}

void ConfigReader::boolean(const std::string& key, bool& value, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  bool read = false;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, read)) return error(key, "must be true or false");
  value = read;
}

void ConfigReader::text(const std::string& key, std::string& value, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) return error(key, "must be text");
  value = node.Scalar();
}

void ConfigReader::choice(const std::string& key, std::string& value, const std::vector<std::string>& allowed,
                          Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  for (const std::string& option : allowed) {
    if (node.IsScalar() && node.Scalar() == option) {
      value = option;
      return;
    }
  }
  error(key, "must be one of: " + join(allowed, ", "));
}

void ConfigReader::vector(const std::string& key, Eigen::Ref<Eigen::VectorXd> value, const Range& range,
                          Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  const std::string wanted = "must be a list of " + std::to_string(value.size()) + " numbers in " + range.text();
  if (!node.IsSequence() || static_cast<Eigen::Index>(node.size()) != value.size()) return error(key, wanted);
  Eigen::VectorXd read(value.size());
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (!YAML::convert<double>::decode(node[i], read[i]) || !range.contains(read[i])) return error(key, wanted);
  }
  value = read;
}

void ConfigReader::texts(const std::string& key, std::vector<std::string>& values, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  std::vector<std::string> read;
  for (std::size_t i = 0; node.IsSequence() && i < node.size() && node[i].IsScalar(); ++i)
    read.push_back(node[i].Scalar());
  if (read.empty() || read.size() != node.size())
    return error(key, "must be a list of one or more scalars, not of lists or maps");
  values = read;
}

void ConfigReader::numbers(const std::string& key, std::vector<double>& values, const Range& range, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  const bool some = node.IsSequence() && node.size() > 0;
  Eigen::VectorXd read(some ? static_cast<Eigen::Index>(node.size()) : 0);
  for (Eigen::Index i = 0; i < read.size(); ++i) {
    const bool good = YAML::convert<double>::decode(node[i], read[i]) && range.contains(read[i]);
    if (!good) return error(key, "must be a list of numbers in " + range.text());
  }
  if (!some) return error(key, "must be a list of numbers in " + range.text());
  values.assign(read.begin(), read.end());
}

YAML::Node ConfigReader::map(const std::string& key, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (node.IsDefined() && node.IsMap()) return node;
  if (node.IsDefined()) error(key, "must be a map");
  return YAML::Node(YAML::NodeType::Map);
}

ConfigReader ConfigReader::section(const std::string& key, Presence presence) {
  return ConfigReader(map(key, presence), origin_, level_->path + key + "/", errors_, levels_);
}

std::vector<ConfigReader> ConfigReader::sections(const std::string& key, Presence presence) {
  const YAML::Node list = find(key, presence);
  std::vector<ConfigReader> readers;
  if (!list.IsDefined()) return readers;
  if (!list.IsSequence()) {
    error(key, "must be a list of maps");
    return readers;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = level_->path + key + "/" + std::to_string(i);
    if (list[i].IsMap()) {
      readers.push_back(ConfigReader(list[i], origin_, path + "/", errors_, levels_));
    } else {
      errors_->push_back(origin_ + ": " + path + ": must be a map");
    }
  }
  return readers;
}

void ConfigReader::finish() {
  for (const auto& level : *levels_) {
    if (!level->map.IsMap()) {
      errors_->push_back(origin_ + ": " + level->path + " must be a map");
      continue;
    }
    std::set<std::string> seen;
    for (const auto& item : level->map) {
      const std::string key = item.first.Scalar();
      if (!seen.insert(key).second) errors_->push_back(origin_ + ": " + level->path + key + ": is there twice");
      if (level->known.count(key)) continue;
      errors_->push_back(origin_ + ": " + level->path + key +
                         ": unknown key; known here: " + join({level->known.begin(), level->known.end()}, ", "));
    }
  }
  if (!errors_->empty()) throw ConfigError(*errors_);
}

YAML::Node loadYamlMap(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw ConfigError(path + ": is a directory; must be a YAML file");
  try {
    YAML::Node node = YAML::LoadFile(path);
    if (!node.IsMap()) throw ConfigError(path + ": must be a YAML map");
    return node;
  } catch (const YAML::BadFile&) {
    throw ConfigError(path + ": cannot be read");
  } catch (const YAML::ParserException& exception) {
    throw ConfigError(path + ": " + exception.what());
  }
}

}  // namespace microinjection
