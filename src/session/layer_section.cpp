#include "session/layer_section.h"

#include <algorithm>
#include <sstream>

#include "base/errors.h"
#include "session/parameter_tree.h"
#include "session/session_choices.h"
#include "session/session_paths.h"

namespace microinjection {
namespace {

bool isOneOf(const LayerSection::Words& words, const std::string& value) {
  return std::find(words.begin(), words.end(), value) != words.end();
}

/// What is allowed: `words`, or `what`.
std::string allowed(const LayerSection::Words& words, const std::string& what) {
  std::string text;
  for (const std::string& word : words) text += (word.empty() ? "\"\"" : word) + " or ";
  return text + what;
}

}  // namespace

LayerSection::LayerSection(ConfigReader reader, const std::string& path, const std::string& folder, Session& session)
    : reader_(std::move(reader)), path_(path), folder_(folder), session_(session) {}

LayerSection LayerSection::section(const std::string& key) {
  return LayerSection(reader_.section(key), path_ + key + "/", folder_, session_);
}

void LayerSection::note(const std::string& key) {
  if (reader_.has(key)) session_.places.of[path_ + key] = reader_.place(key);
}

void LayerSection::text(const std::string& key, std::string& value) {
  note(key);
  reader_.text(key, value);
}

void LayerSection::choice(const std::string& key, std::string& value, const Words& words) {
  note(key);
  reader_.choice(key, value, words);
}

void LayerSection::flag(const std::string& key, bool& value) {
  note(key);
  reader_.boolean(key, value);
}

void LayerSection::flag(const std::string& key, std::optional<bool>& value) {
  note(key);
  const YAML::Node node = reader_.any(key);
  if (!node.IsDefined()) return;
  bool read = false;
  if (node.IsScalar() && node.Scalar() == kAuto) {
    value.reset();
  } else if (node.IsScalar() && YAML::convert<bool>::decode(node, read)) {
    value = read;
  } else {
    reader_.error(key, "must be true, false or auto");
  }
}

void LayerSection::number(const std::string& key, std::optional<double>& value, const Range& range) {
  const YAML::Node node = reader_.any(key);
  if (!node.IsDefined()) return;
  value.reset();
  if (node.IsScalar() && node.Scalar() == kAuto) return note(key);
  number(key, value.emplace(), range);
}

void LayerSection::number(const std::string& key, double& value, const Range& range) {
  note(key);
  reader_.number(key, value, range);
}

void LayerSection::integer(const std::string& key, int& value, const Range& range) {
  note(key);
  reader_.integer(key, value, range);
}

void LayerSection::numbers(const std::string& key, std::array<double, 6>& value) {
  note(key);
  reader_.vector(key, Eigen::Map<Eigen::VectorXd>(value.data(), value.size()));
}

std::optional<std::string> LayerSection::textOf(const std::string& key) {
  note(key);
  const YAML::Node node = reader_.any(key);
  if (!node.IsDefined()) return std::nullopt;
  if (node.IsScalar()) return node.Scalar();
  reader_.error(key, "must be text");
  return std::nullopt;
}

void LayerSection::path(const std::string& key, std::string& value, const Words& words) {
  if (const std::optional<std::string> read = textOf(key)) {
    const bool in_network = read->rfind("udp:", 0) == 0;
    value = in_network || isOneOf(words, *read) ? *read : absolutePath(*read, folder_);
  }
}

void LayerSection::existingFile(const std::string& key, std::string& value, const Words& words) {
  std::string read = value;
  path(key, read, words);
  if (read != value && !isOneOf(words, read) && !isFile(read)) {
    reader_.error(key, "no such file: " + read + "; must be " + allowed(words, "the path of a file"));
  } else {
    value = read;
  }
}

void LayerSection::fileOrName(const std::string& key, std::string& value, const std::string& below,
                              const Words& words) {
  const std::optional<std::string> read = textOf(key);
  if (!read) return;
  const std::string found = isOneOf(words, *read) ? *read : pathOfFileOrName(*read, folder_, session_.package, below);
  if (isOneOf(words, *read) || isFile(found)) {
    value = found;
  } else {
    reader_.error(key, "no such file: " + found + "; must be " + allowed(words, "a path, or a name of ") + below +
                           ": " + join(namesIn(session_.package, below), ", "));
  }
}

void LayerSection::overrides(const std::string& key) {
  const YAML::Node node = reader_.any(key);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) {
    ConfigReader section = reader_.section(key);
    return readOverrides(section);
  }
  const std::string path = absolutePath(node.Scalar(), folder_);
  try {
    ConfigReader file = ConfigReader::ofFile(path);
    readOverrides(file);
    file.finish();
    session_.files.push_back(path);
  } catch (const ConfigError& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) reader_.error(key, line);
  }
}

void LayerSection::readOverrides(ConfigReader& reader) {
  for (const std::string& node : overridableNodes()) {
    const YAML::Node values = reader.any(node);
    if (!values.IsDefined()) continue;
    if (!values.IsMap()) {
      reader.error(node, "must be keys with values");
      continue;
    }
    noteOverrides(reader, values, node, reader.place(node));
    if (!session_.overrides[node].IsDefined()) session_.overrides[node] = YAML::Node(YAML::NodeType::Map);
    mergeParameters(session_.overrides[node], values);
  }
}

void LayerSection::noteOverrides(ConfigReader& reader, const YAML::Node& map, const std::string& path,
                                 const std::string& origin) {
  const std::string file = origin.substr(0, origin.find(", line "));
  for (const auto& item : map) {
    const std::string key = path + "/" + (item.first.IsScalar() ? item.first.Scalar() : "");
    const bool has_line = file != origin && !item.first.Mark().is_null();
    const std::string place = has_line ? file + ", line " + std::to_string(item.first.Mark().line + 1) : origin;
    session_.places.of["overrides/" + key] = place;
    if (item.second.IsNull()) reader.error(key, "must have a value");
    if (item.second.IsMap()) noteOverrides(reader, item.second, key, place);
  }
}

}  // namespace microinjection
