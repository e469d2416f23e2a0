#include "nodes/haptic/device_settings.h"

#include <std_msgs/Bool.h>

#include <algorithm>

#include "nodes/haptic/force_receiver.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kSettle = 0.2;  // s, from the connection until the driver has taken what was latched

}  // namespace

std::string deviceTopic(const std::string& device, const std::string& name) {
  return name.empty() || name[0] == '/' ? name : device + "/" + name;
}

std::vector<DeviceSetting> DeviceSetting::readAll(ConfigReader& reader, const std::string& key) {
  std::vector<DeviceSetting> settings;
  for (ConfigReader& one : reader.sections(key)) {
    DeviceSetting setting;
    one.text("topic", setting.topic, ConfigReader::kRequired);
    one.boolean("value", setting.value, ConfigReader::kRequired);
    settings.push_back(setting);
  }
  return settings;
}

DeviceSettings::DeviceSettings(ros::NodeHandle& node, const std::string& device,
                               const std::vector<DeviceSetting>& settings) {
  for (const DeviceSetting& setting : settings) {
    told_.push_back({setting, node.advertise<std_msgs::Bool>(deviceTopic(device, setting.topic), 1, true)});
    std_msgs::Bool message;
    message.data = setting.value;
    told_.back().publisher.publish(message);
  }
}

bool DeviceSettings::taken(const std::string& driver, const ros::Time& now) {
  const auto unheard =
      std::find_if(told_.begin(), told_.end(), [&](const Told& told) { return !isSubscribed(told.publisher, driver); });
  missing_ = unheard == told_.end() ? "" : unheard->publisher.getTopic();
  if (unheard != told_.end()) {
    since_ = ros::Time();
    said_ = false;
    return false;
  }
  if (since_.isZero()) since_ = now;
  if (secondsBetween(since_, now) < kSettle && !told_.empty()) return false;
  for (const Told& told : told_) {
    if (!said_) ROS_INFO_STREAM("told " << driver << ": " << told.publisher.getTopic() << " = " << told.setting.value);
  }
  said_ = true;
  return true;
}

}  // namespace microinjection
