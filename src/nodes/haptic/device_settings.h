#pragma once

#include <std_msgs/Bool.h>

#include <string>
#include <vector>

#include "base/config_reader.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// A switch of a driver, a topic of std_msgs/Bool.
struct DeviceSetting {
  std::string topic;  ///< below the device's namespace, or absolute
  bool value = true;

  static std::vector<DeviceSetting> readAll(ConfigReader& reader, const std::string& key);
};

/// Publishes the settings that a driver needs to render forces as the bridge defines them. They are
/// latched, so a driver that starts later or restarts receives them, too.
class DeviceSettings {
 public:
  DeviceSettings(Bus& bus, const std::string& device, const std::vector<DeviceSetting>& settings);

  /// Whether `driver` has been connected to all of them for 0.2 s. It then has received each before
  /// the first force, which arrives on another connection.
  bool received(const std::string& driver, const ros::Time& now);
  /// The first one without a connection to `driver`; empty: none.
  const std::string& missing() const { return missing_; }

 private:
  struct Published {
    DeviceSetting setting;
    Publisher<std_msgs::Bool> publisher;
  };

  std::vector<Published> published_;
  ros::Time since_;  ///< all are connected; zero: not yet
  bool logged_ = false;
  std::string missing_;
};

/// A topic of a device: `name` below its namespace, or `name` itself where it is absolute.
std::string deviceTopic(const std::string& device, const std::string& name);

}  // namespace microinjection
