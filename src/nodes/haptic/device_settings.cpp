#include "nodes/haptic/device_settings.h"

#include <ros/console.h>

#include <algorithm>

#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kSettle = 0.2;  // s, from the connection until the driver has received the latched settings

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

DeviceSettings::DeviceSettings(Bus& bus, const std::string& device, const std::vector<DeviceSetting>& settings) {
  for (const DeviceSetting& setting : settings) {
    published_.push_back({setting, bus.advertise<std_msgs::Bool>(deviceTopic(device, setting.topic), 1, true)});
    std_msgs::Bool message;
    message.data = setting.value;
    published_.back().publisher.publish(message);
  }
}

bool DeviceSettings::received(const std::string& driver, const ros::Time& now) {
  const auto missing = std::find_if(published_.begin(), published_.end(),
                                    [&](const Published& entry) { return !entry.publisher.isSubscribedBy(driver); });
  missing_ = missing == published_.end() ? "" : missing->publisher.topic();
  if (missing != published_.end()) {
    since_ = ros::Time();
    logged_ = false;
    return false;
  }
  if (since_.isZero()) since_ = now;
  if (!isDue(since_, now, kSettle) && !published_.empty()) return false;
  for (const Published& entry : published_) {
    if (!logged_)
      ROS_INFO_STREAM("sent to " << driver << ": " << entry.publisher.topic() << " = " << entry.setting.value);
  }
  logged_ = true;
  return true;
}

}  // namespace microinjection
