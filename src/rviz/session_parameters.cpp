#include "rviz/session_parameters.h"

#include "operation/console/parameter_number.h"

namespace microinjection {

std::optional<double> SessionParameters::numberOf(const std::string& key, const YAML::Node& value) {
  if (value.IsScalar()) return parameterNumber(node_, key, value.as<std::string>(), error_);
  error_ += (error_.empty() ? "" : "; ") + node_ + "/" + key + " must be a number";
  return std::nullopt;
}

std::optional<double> SessionParameters::number(const std::string& key) {
  const YAML::Node value = bus_.parameter(node_ + "/" + key);
  return value.IsNull() ? std::nullopt : numberOf(key, value);
}

std::vector<double> SessionParameters::numbers(const std::string& key) {
  const YAML::Node list = bus_.parameter(node_ + "/" + key);
  if (!list.IsSequence()) return {};
  std::vector<double> values;
  for (const YAML::Node& item : list) {
    const auto value = numberOf(key, item);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

std::string SessionParameters::text(const std::string& key) const {
  const YAML::Node value = bus_.parameter(node_ + "/" + key);
  return value.IsScalar() ? value.as<std::string>() : "";
}

}  // namespace microinjection
