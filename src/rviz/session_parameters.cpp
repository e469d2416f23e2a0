#include "rviz/session_parameters.h"

#include <ros/param.h>

#include "operation/console/parameter_number.h"

namespace microinjection {

std::optional<double> SessionParameters::number(const std::string& key) {
  const std::string name = node_ + "/" + key;
  double value = 0;
  if (ros::param::get(name, value)) return value;
  std::string text;
  if (ros::param::get(name, text)) return parameterNumber(node_, key, text, error_);
  if (ros::param::has(name)) error_ += (error_.empty() ? "" : "; ") + name + " must be a number";
  return std::nullopt;
}

std::string SessionParameters::text(const std::string& key) const {
  std::string value;
  ros::param::get(node_ + "/" + key, value);
  return value;
}

}  // namespace microinjection
