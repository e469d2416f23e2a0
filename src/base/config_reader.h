#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/range.h"

namespace microinjection {

/// Strict reader of one YAML map: a scene, a session, a rig, the parameters of a node. A misspelt key or a value out of
/// range must never become a default in silence, because a needle would then move with a speed or a force limit that
/// nobody has chosen.
///
/// The reader collects every error (missing, wrong type, out of range, unknown key) with the full key path, the value
/// and what is allowed, and finish() throws them all at once as ConfigError. yaml-cpp's own node["x"].as<double>()
/// throws at the first error instead and does not know the path of its key, so a user would mend a file one error at a
/// time.
///
///     ConfigReader reader(YAML::LoadFile(path), path);
///     reader.number("diameter", config.diameter, Range::positive());  // optional: keeps the default
///     ConfigReader cell = reader.section("cell");  // nested map, shares the error list
///     reader.finish();  // unknown keys anywhere are errors
///
/// A key is known because the code asked for it. There is no list of the allowed keys beside the code, which could
/// differ from what the code reads. So each level remembers the keys that it was asked for, also the optional ones, and
/// finish() compares them with those in the file:
///
///     reader                      Level ""
///       section("cell")           Level "cell/"                     Shared: origin, errors,
///         section("material")     Level "cell/material/"            all levels
///         sections("layers")      Level "cell/layers/0/", ...
///
/// The functions that read do not throw. Where a key is absent or wrong, its value stays what it was, so that the
/// caller can read on and the user gets all errors; do not use the values before finish() has returned.
class ConfigReader {
 public:
  enum class Presence { kOptional, kRequired };
  static constexpr Presence kOptional = Presence::kOptional;
  static constexpr Presence kRequired = Presence::kRequired;

  /// `origin` names the file or the parameter namespace in messages. A `map` that is no map is an error of finish().
  ConfigReader(const YAML::Node& map, const std::string& origin);
  /// Reader of a YAML file whose messages name the line, too: "lab.yaml, line 3: rig/name = lathe: ...". A key that is
  /// anywhere in the file twice is an error. Throws ConfigError when the file cannot be read.
  static ConfigReader ofFile(const std::string& path);

  /// Whether the key is there, with any value. Asking does not make it a known key.
  bool has(const std::string& key) const;
  /// A finite number. One that begins with a 0 before other digits is refused, here and in all functions that read
  /// numbers, because 010 is 8 in YAML 1.1 and 10 in YAML 1.2.
  void number(const std::string& key, double& value, const Range& range = Range::finite(), Presence = kOptional);
  void integer(const std::string& key, int& value, const Range& range = Range::finite(), Presence = kOptional);
  void boolean(const std::string& key, bool& value, Presence = kOptional);
  void text(const std::string& key, std::string& value, Presence = kOptional);
  /// The path of a file or folder in a node's parameters: absolute, from the home folder (~/), or, where it is
  /// optional, "". A relative one is an error: it would be meant from the folder of whoever wrote it, and a node that
  /// roslaunch starts would take it from ROS's own folder (~/.ros).
  void path(const std::string& key, std::string& value, Presence = kOptional);
  /// One of `allowed`.
  void choice(const std::string& key, std::string& value, const std::vector<std::string>& allowed,
              Presence = kOptional);
  /// A list of exactly value.size() numbers, each in `range`.
  void vector(const std::string& key, Eigen::Ref<Eigen::VectorXd> value, const Range& range = Range::finite(),
              Presence = kOptional);
  /// A list of scalars as they stand in the file, at least one.
  void texts(const std::string& key, std::vector<std::string>& values, Presence = kOptional);
  /// A list of numbers in `range`, at least one.
  void numbers(const std::string& key, std::vector<double>& values, const Range& range = Range::finite(),
               Presence = kOptional);
  /// The map under `key`; an empty map when it is optional and absent.
  ConfigReader section(const std::string& key, Presence = kOptional);
  /// The maps in the list under `key`, one reader each; none when it is optional and absent.
  /// Messages name them key/0, key/1 and so on.
  std::vector<ConfigReader> sections(const std::string& key, Presence = kOptional);

  /// The value under `key`, whatever it is; undefined when it is absent. The key counts as known, and the caller checks
  /// what is in it: a value that has a reader of its own, as the scene in a family file.
  YAML::Node any(const std::string& key);

  /// Adds an error about `key`: "origin: cell/diameter = 3: MESSAGE".
  void error(const std::string& key, const std::string& message);
  /// Where `key` is: the file, and the line of a reader made by ofFile.
  std::string place(const std::string& key) const;

  /// Throws ConfigError when there was an error here or in a section, or a key that was never read. One call is enough
  /// for a file: the readers of its sections share the errors and the levels.
  void finish();

 private:
  struct Level;
  struct Shared;  ///< by all sections of a reader
  ConfigReader(const YAML::Node& map, const std::string& path, std::shared_ptr<Shared> shared);
  void add(const std::string& place, const std::string& message);
  const YAML::Node find(const std::string& key, Presence presence);
  YAML::Node map(const std::string& key, Presence presence);  ///< empty when it is absent
  std::string valueText(const std::string& key) const;

  std::shared_ptr<Shared> shared_;
  std::shared_ptr<Level> level_;
};

/// Loads a YAML map; ConfigError names the file when it is absent, malformed (with line), not a map, or when a key is
/// in one of its maps twice (with both lines), which YAML forbids and yaml-cpp passes over.
YAML::Node loadYamlMap(const std::string& path);

}  // namespace microinjection
