#include "python/bindings/scene_value.h"

#include <sstream>
#include <utility>

#include "base/config_reader.h"
#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {

namespace py = pybind11;

namespace {

std::string textOf(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

void set(YAML::Node node, const std::string& path, const YAML::Node& value, const std::string& whole) {
  const std::size_t slash = path.find('/');
  const std::string key = path.substr(0, slash);
  if (node.IsDefined() && !node.IsNull() && !node.IsMap() && !node.IsSequence())
    throw ConfigError(whole + ": a value stands above it, and no map");
  if (node.IsSequence()) {
    const auto index = parseNumber<std::size_t>(key);
    if (!index || *index >= node.size())
      throw ConfigError(whole + ": " + key + " must be a number from 0 to " + std::to_string(node.size() - 1));
    if (slash == std::string::npos) {
      node[*index] = value;
    } else {
      set(node[*index], path.substr(slash + 1), value, whole);
    }
    return;
  }
  if (slash == std::string::npos) {
    node[key] = value;
  } else {
    set(node[key], path.substr(slash + 1), value, whole);
  }
}

}  // namespace

YAML::Node toYaml(const py::handle& value) {
  if (value.is_none()) return YAML::Node(YAML::NodeType::Null);
  if (py::isinstance<py::bool_>(value)) return YAML::Node(value.cast<bool>() ? "true" : "false");
  if (py::isinstance<py::str>(value)) return YAML::Node(value.cast<std::string>());
  if (py::isinstance<py::int_>(value)) return YAML::Node(py::str(value).cast<std::string>());
  if (py::isinstance<py::float_>(value)) return YAML::Node(textOf(value.cast<double>()));
  if (py::isinstance<py::dict>(value)) {
    YAML::Node map(YAML::NodeType::Map);
    for (const auto& [key, item] : py::reinterpret_borrow<py::dict>(value))
      map[py::str(key).cast<std::string>()] = toYaml(item);
    return map;
  }
  if (py::hasattr(value, "tolist")) return toYaml(value.attr("tolist")());
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    YAML::Node list(YAML::NodeType::Sequence);
    for (const auto& item : value) list.push_back(toYaml(item));
    return list;
  }
  throw ConfigError("a value of type " + py::str(py::type::of(value).attr("__name__")).cast<std::string>() +
                    ": must be a number, a text, a list, a dict or None");
}

py::object fromYaml(const YAML::Node& node) {
  if (node.IsMap()) {
    py::dict map;
    for (const auto& entry : node) map[py::str(entry.first.Scalar())] = fromYaml(entry.second);
    return map;
  }
  if (node.IsSequence()) {
    py::list list;
    for (const auto& item : node) list.append(fromYaml(item));
    return list;
  }
  if (!node.IsScalar()) return py::none();
  const bool quoted = node.Tag() == "!";
  if (const auto whole = parseNumber<long>(node.Scalar()); whole && !quoted) return py::int_(*whole);
  if (const auto number = parseNumber<double>(node.Scalar()); number && !quoted) return py::float_(*number);
  if (!quoted && (node.Scalar() == "true" || node.Scalar() == "false")) return py::bool_(node.Scalar() == "true");
  return py::str(node.Scalar());
}

SceneValue::SceneValue(const YAML::Node& keys, std::string origin)
    : keys_(YAML::Clone(keys)),
      origin_(std::move(origin)),
      scene_(std::make_shared<const Scene>(parseScene(keys_, origin_))) {}

SceneValue SceneValue::load(const std::string& path) { return {loadYamlMap(path), path}; }

SceneValue SceneValue::with(const py::dict& changes) const {
  YAML::Node changed = YAML::Clone(keys_);
  for (const auto& [key, value] : changes) {
    const auto path = py::str(key).cast<std::string>();
    set(changed, path, toYaml(value), path);
  }
  return {changed, origin_ + " (changed)"};
}

std::string SceneValue::text() const {
  YAML::Emitter out;
  out << keys_;
  return std::string(out.c_str()) + '\n';
}

py::object SceneValue::keys() const { return fromYaml(keys_); }

}  // namespace microinjection
