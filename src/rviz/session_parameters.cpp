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

std::vector<double> SessionParameters::numbers(const std::string& key) {
  XmlRpc::XmlRpcValue list;
  if (!ros::param::get(node_ + "/" + key, list) || list.getType() != XmlRpc::XmlRpcValue::TypeArray) return {};
  std::vector<double> values;
  for (int i = 0; i < list.size(); ++i) {
    XmlRpc::XmlRpcValue& item = list[i];
    std::optional<double> value;
    if (item.getType() == XmlRpc::XmlRpcValue::TypeDouble) value = static_cast<double>(item);
    if (item.getType() == XmlRpc::XmlRpcValue::TypeInt) value = static_cast<int>(item);
    if (item.getType() == XmlRpc::XmlRpcValue::TypeString)
      value = parameterNumber(node_, key, static_cast<std::string>(item), error_);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

std::string SessionParameters::text(const std::string& key) const {
  std::string value;
  ros::param::get(node_ + "/" + key, value);
  return value;
}

}  // namespace microinjection
