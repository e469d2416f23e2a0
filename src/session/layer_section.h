#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "session/session.h"

namespace microinjection {

/// A section of one file of a session, or of its arguments. It sets what is there, makes paths absolute and notes in
/// session.places where each key was. Errors go to the reader.
class LayerSection {
 public:
  using Words = std::vector<std::string>;

  /// `path`: "" or "rig/"; `folder`: relative paths are meant from there.
  LayerSection(ConfigReader reader, const std::string& path, const std::string& folder, Session& session);
  LayerSection section(const std::string& key);

  void text(const std::string& key, std::string& value);
  void choice(const std::string& key, std::string& value, const Words& allowed);
  void flag(const std::string& key, bool& value);
  void flag(const std::string& key, std::optional<bool>& value);  ///< true, false, or auto: no value
  void number(const std::string& key, double& value, const Range& range);
  void number(const std::string& key, std::optional<double>& value, const Range& range);  ///< auto: no value
  void integer(const std::string& key, int& value, const Range& range);
  void numbers(const std::string& key, std::array<double, 6>& value);

  /// A path that need not be there. `words` stand for themselves, and so does an address in the network (udp:...).
  void path(const std::string& key, std::string& value, const Words& words);
  void existingFile(const std::string& key, std::string& value, const Words& words);
  /// NAME of package/`below`/NAME.yaml, or a path.
  void fileOrName(const std::string& key, std::string& value, const std::string& below, const Words& words = {});
  /// NODE: {KEY: VALUE}, or the path of a file with these, is merged into session.overrides.
  void overrides(const std::string& key);

 private:
  void note(const std::string& key);
  std::optional<std::string> textOf(const std::string& key);
  void readOverrides(ConfigReader& reader);
  void noteOverrides(ConfigReader& reader, const YAML::Node& map, const std::string& path, const std::string& origin);

  ConfigReader reader_;
  std::string path_, folder_;
  Session& session_;
};

}  // namespace microinjection
