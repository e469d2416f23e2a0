#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

/// A switch of a driver's, a topic of std_msgs/Bool.
struct DeviceSetting {
  std::string topic;  ///< below the device's namespace, or absolute
  bool value = true;

  static std::vector<DeviceSetting> readAll(ConfigReader& reader, const std::string& key);
};

/// What a driver must be told before a force is meant as we mean it, latched: a driver that is started later, or again,
/// hears it, too.
class DeviceSettings {
 public:
  DeviceSettings(ros::NodeHandle& node, const std::string& device, const std::vector<DeviceSetting>& settings);

  /// Whether `driver` has been connected to all of them for 0.2 s: it has heard each before the first force comes on
  /// another connection.
  bool taken(const std::string& driver, const ros::Time& now);
  /// The first one that `driver` does not hear; empty when it hears all.
  const std::string& missing() const { return missing_; }

 private:
  struct Told {
    DeviceSetting setting;
    ros::Publisher publisher;
  };

  std::vector<Told> told_;
  ros::Time since_;  ///< all are heard; zero: not yet
  bool said_ = false;
  std::string missing_;
};

/// A topic of a device: `name` below its namespace, or `name` itself where it is absolute.
std::string deviceTopic(const std::string& device, const std::string& name);

}  // namespace microinjection
