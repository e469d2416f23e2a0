#pragma once

#include <pybind11/pybind11.h>
#include <yaml-cpp/yaml.h>

#include <memory>
#include <string>

#include "cell/model/scene.h"

namespace microinjection {

/// A scene as Python has it: the keys of its file, and what they mean. It never changes, so that a cell that another
/// thread uses stays what it is.
class SceneValue {
 public:
  /// @throws ConfigError that names key, value and what is allowed
  SceneValue(const YAML::Node& keys, std::string origin);
  static SceneValue load(const std::string& path);

  /// The same with other values, such as {"cell/diameter": 60e-6}.
  SceneValue with(const pybind11::dict& changes) const;
  std::string text() const;  ///< of the file
  pybind11::object keys() const;
  const Scene& scene() const { return *scene_; }
  const std::string& origin() const { return origin_; }

 private:
  YAML::Node keys_;
  std::string origin_;
  std::shared_ptr<const Scene> scene_;
};

/// What YAML has for a Python value: None, numbers, texts, lists, tuples, arrays of numpy and dicts.
YAML::Node toYaml(const pybind11::handle& value);
/// Maps become dicts, lists lists, and a scalar what it is in YAML.
pybind11::object fromYaml(const YAML::Node& node);

}  // namespace microinjection
