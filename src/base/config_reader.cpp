#include "base/config_reader.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/errors.h"
#include "base/paths.h"

namespace microinjection {

namespace {

/// Characters that look like a blank, like nothing or like a minus, and are none in YAML.
struct Deceptive {
  const char* bytes;
  const char* name;
};
constexpr Deceptive kDeceptive[] = {
    {"\xc2\xa0", "no-break space U+00A0"},       {"\xe2\x80\x87", "figure space U+2007"},
    {"\xe2\x80\x89", "thin space U+2009"},       {"\xe2\x80\xaf", "narrow no-break space U+202F"},
    {"\xe2\x80\x8b", "zero width space U+200B"}, {"\xef\xbb\xbf", "byte order mark U+FEFF"},
    {"\xe2\x88\x92", "minus sign U+2212"}};

const Deceptive* deceptiveAt(const std::string& text, std::size_t at) {
  for (const Deceptive& each : kDeceptive)
    if (text.compare(at, std::string(each.bytes).size(), each.bytes) == 0) return &each;
  return nullptr;
}

bool isDeceptive(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (deceptiveAt(text, i)) return true;
  return false;
}

/// Replaces control characters by their codes, and deceptive ones by their names. A carriage return would hide the text
/// before it on a terminal.
std::string visible(const std::string& text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (const Deceptive* deceptive = deceptiveAt(text, i)) {
      shown += std::string("<") + deceptive->name + ">";
      i += std::string(deceptive->bytes).size() - 1;
      continue;
    }
    const char each = text[i];
    const auto code = static_cast<unsigned char>(each);
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, code < 0x20 || code == 0x7f ? "\\x%02x" : "%c", code);
    shown += escaped;
  }
  return shown;
}

std::string lineOf(const YAML::Mark& mark) {
  return mark.is_null() ? std::string() : ", line " + std::to_string(mark.line + 1);
}

/// Where a file that is no YAML has a tab before a key, or a character that looks like a blank: "; line 3 has a tab".
std::string whereDeceptive(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string text = line.substr(0, line.find('#'));
    const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
    const bool has_tab = text.find('\t') < start && start < text.size();
    if (has_tab) return "; line " + std::to_string(number) + " begins with a tab: must be spaces";
    for (std::size_t i = 0; i < text.size(); ++i) {
      const Deceptive* deceptive = deceptiveAt(text, i);
      if (deceptive && (number > 1 || i > 0))
        return "; line " + std::to_string(number) + " has a " + deceptive->name + ": must be a plain character";
    }
  }
  return "";
}

/// A number of digits alone that begins with 0: 010 is 8 in YAML 1.1, and 10 in YAML 1.2.
bool hasLeadingZero(const YAML::Node& node) {
  if (!node.IsScalar()) return false;
  const std::string& text = node.Scalar();
  const std::size_t sign = text.find_first_of("+-") == 0 ? 1 : 0;
  return text.size() > sign + 1 && text[sign] == '0' &&
         text.find_first_not_of("0123456789_", sign) == std::string::npos;
}

constexpr char kNoLeadingZero[] = "must be written without the leading zero: some programs would read it as octal";

/// Finds keys that are in one map twice, and values without an end: an alias can contain itself.
class DuplicateSearch {
 public:
  explicit DuplicateSearch(const std::string& origin) : origin_(origin) {}

  std::vector<std::string> search(const YAML::Node& node) {
    visit(node, "", 0);
    return errors_;
  }
  bool endless() const { return endless_; }

 private:
  static constexpr int kDepth = 64, kValues = 100000;

  void visit(const YAML::Node& node, const std::string& path, int depth) {
    if (endless_) return;
    if (depth > kDepth || ++values_ > kValues) {
      endless_ = true;
      errors_.push_back(origin_ + lineOf(node.Mark()) + ": " + path +
                        " has too many values; does an alias contain itself?");
      return;
    }
    if (node.IsSequence()) {
      for (std::size_t i = 0; i < node.size(); ++i) visit(node[i], path + std::to_string(i) + "/", depth + 1);
    } else if (node.IsMap()) {
      visitMap(node, path, depth);
    }
  }

  void visitMap(const YAML::Node& map, const std::string& path, int depth) {
    std::map<std::string, YAML::Mark> seen;
    for (const auto& item : map) {
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
      const auto [first, is_new] = seen.emplace(key, item.first.Mark());
      if (!is_new) {
        errors_.push_back(origin_ + lineOf(item.first.Mark()) + ": " + path + visible(key) +
                          ": is there twice, first in line " + std::to_string(first->second.line + 1) +
                          "; must be there once");
      }
      visit(item.second, path + key + "/", depth + 1);
    }
  }

  std::string origin_;
  std::vector<std::string> errors_;
  int values_ = 0;
  bool endless_ = false;
};

YAML::Node loadMap(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw ConfigError(path + ": is a directory; must be a YAML file");
  try {
    YAML::Node node = YAML::LoadFile(path);
    if (!node.IsMap()) throw ConfigError(path + ": must be a YAML map");
    return node;
  } catch (const YAML::BadFile&) {
    throw ConfigError(path + ": cannot be read");
  } catch (const YAML::ParserException& exception) {
    throw ConfigError(path + ": " + exception.what() + whereDeceptive(path));
  }
}

}  // namespace

struct ConfigReader::Level {
  YAML::Node map;
  std::string path;  ///< "" or "cell/material/"
  std::set<std::string> known;
};

struct ConfigReader::Shared {
  std::string origin;
  bool of_file = false;  ///< messages name lines, and keys that are there twice have been found
  std::vector<std::string> errors;
  std::vector<std::shared_ptr<Level>> levels;
};

ConfigReader::ConfigReader(const YAML::Node& map, const std::string& origin)
    : ConfigReader(map, "", std::make_shared<Shared>()) {
  shared_->origin = origin;
}

ConfigReader::ConfigReader(const YAML::Node& map, const std::string& path, std::shared_ptr<Shared> shared)
    : shared_(std::move(shared)), level_(std::make_shared<Level>()) {
  level_->map.reset(map);
  level_->path = path;
  shared_->levels.push_back(level_);
}

ConfigReader ConfigReader::ofFile(const std::string& path) {
  ConfigReader reader(loadMap(path), path);
  reader.shared_->of_file = true;
  DuplicateSearch search(path);
  reader.shared_->errors = search.search(reader.level_->map);
  if (search.endless()) throw ConfigError(reader.shared_->errors);  // no message could show it
  return reader;
}

void ConfigReader::add(const std::string& place, const std::string& message) {
  shared_->errors.push_back(place + ": " + level_->path + message);
}

std::string ConfigReader::place(const std::string& key) const {
  if (!shared_->of_file) return shared_->origin;
  if (level_->map.IsMap()) {
    for (const auto& item : level_->map)
      if (item.first.IsScalar() && item.first.Scalar() == key) return shared_->origin + lineOf(item.first.Mark());
  }
  return shared_->origin + lineOf(level_->map.Mark());
}

bool ConfigReader::has(const std::string& key) const {
  const YAML::Node& map = level_->map;
  return map.IsMap() && map[key].IsDefined();
}

const YAML::Node ConfigReader::find(const std::string& key, Presence presence) {
  level_->known.insert(key);
  if (has(key)) return static_cast<const YAML::Node&>(level_->map)[key];
  if (presence == kRequired) add(place(key), key + " is missing");
  return YAML::Node(YAML::NodeType::Undefined);
}

YAML::Node ConfigReader::any(const std::string& key) { return find(key, kOptional); }

std::string ConfigReader::valueText(const std::string& key) const {
  if (!has(key)) return "";
  const YAML::Node node = static_cast<const YAML::Node&>(level_->map)[key];
  if (node.IsScalar() && isDeceptive(node.Scalar())) return " = " + visible(node.Scalar());
  YAML::Emitter out;
  out << YAML::Flow << node;
  return std::string(" = ") + visible(out.c_str());
}

void ConfigReader::error(const std::string& key, const std::string& message) {
  add(place(key), key + valueText(key) + ": " + message);
}

void ConfigReader::number(const std::string& key, double& value, const Range& range, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  double read = 0;
  if (hasLeadingZero(node)) return error(key, kNoLeadingZero);
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, read)) return error(key, "must be a number");
  if (!range.contains(read)) return error(key, "must be a number in " + range.text());
  value = read;
}

void ConfigReader::integer(const std::string& key, int& value, const Range& range, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  int read = 0;
  if (hasLeadingZero(node)) return error(key, kNoLeadingZero);
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

void ConfigReader::path(const std::string& key, std::string& value, Presence presence) {
  const YAML::Node node = find(key, presence);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) return error(key, "must be text");
  const std::string read = node.Scalar();
  const bool home = read.rfind("~/", 0) == 0, none = read.empty() && presence == kOptional;
  if (!none && !home && read.rfind('/', 0) != 0)
    return error(key, "must be an absolute path, or begin with ~/: a node does not run in your folder");
  value = home ? absolutePath(read, "/") : read;
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
    if (hasLeadingZero(node[i])) return error(key, kNoLeadingZero);
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
    if (hasLeadingZero(node[i])) return error(key, kNoLeadingZero);
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
  return ConfigReader(map(key, presence), level_->path + key + "/", shared_);
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
    const std::string name = key + "/" + std::to_string(i);
    if (list[i].IsMap()) {
      readers.push_back(ConfigReader(list[i], level_->path + name + "/", shared_));
    } else {
      add(place(key), name + ": must be a map");
    }
  }
  return readers;
}

void ConfigReader::finish() {
  std::vector<std::string>& errors = shared_->errors;
  for (const auto& level : shared_->levels) {
    if (!level->map.IsMap()) {
      errors.push_back(shared_->origin + ": " + level->path + " must be a map");
      continue;
    }
    std::set<std::string> seen;
    for (const auto& item : level->map) {
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
      const std::string where = shared_->origin + (shared_->of_file ? lineOf(item.first.Mark()) : "") + ": " +
                                level->path + visible(key) + ": ";
      if (!seen.insert(key).second && !shared_->of_file) errors.push_back(where + "is there twice");
      if (level->known.count(key)) continue;
      errors.push_back(where + "unknown key; known here: " + join({level->known.begin(), level->known.end()}, ", "));
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
}

YAML::Node loadYamlMap(const std::string& path) {
  YAML::Node map = loadMap(path);
  const std::vector<std::string> errors = DuplicateSearch(path).search(map);
  if (!errors.empty()) throw ConfigError(errors);
  return map;
}

}  // namespace microinjection
