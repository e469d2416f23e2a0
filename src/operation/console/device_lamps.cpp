#include "operation/console/device_lamps.h"

#include <cstddef>
#include <optional>

#include "operation/console/figures.h"

namespace microinjection {
namespace {

struct Owner {
  const char* node;
  Device device;
};

constexpr Owner kOwners[] = {
    {"micromanipulator", Device::kRig}, {"camera", Device::kCamera},      {"microscope", Device::kCamera},
    {"force_sensor", Device::kSensor},  {"haptic_device", Device::kHand}, {"keyboard_hand", Device::kHand},
    {"virtual_hand", Device::kHand},    {"haptic_bridge", Device::kHand}, {"cell_simulator", Device::kCell}};

std::optional<Device> ownerOf(const std::string& name) {
  const std::string node = name.substr(0, name.find(':'));
  for (const Owner& owner : kOwners) {
    if (node == owner.node) return owner.device;
  }
  return std::nullopt;
}

Light lightOf(int level) { return level == 0 ? Light::kGreen : level == 1 ? Light::kYellow : Light::kRed; }

}  // namespace

const char* toText(Device device) {
  constexpr const char* kNames[] = {"Rig", "Camera", "Sensor", "Hand", "Cell"};
  return kNames[static_cast<std::size_t>(device)];
}

void DeviceLamps::receive(const NodeReport& report, double now) {
  if (const auto device = ownerOf(report.name)) {
    heard_[static_cast<std::size_t>(*device)][report.name] = {report, now};
  }
}

Lamp DeviceLamps::lamp(Device device, double now) const {
  const auto& tasks = heard_[static_cast<std::size_t>(device)];
  if (tasks.empty()) return {Light::kGrey, "none reports"};
  Lamp worst{Light::kGrey, ""};
  for (const auto& [name, heard] : tasks) {
    const double age = now - heard.at;
    Lamp lamp{lightOf(heard.report.level), heard.report.message};
    if (age > kSilence) {
      lamp = {Light::kRed, name.substr(0, name.find(':')) + " is silent for " + figure(age, 1, 0) + " s"};
    }
    // The last task is the node's own; "cycle" and "inputs" come before it in each message, and in the alphabet here.
    const bool own = name.find(": cycle") == std::string::npos && name.find(": inputs") == std::string::npos;
    if (lamp.light > worst.light || (lamp.light == worst.light && own)) worst = lamp;
  }
  return worst;
}

}  // namespace microinjection
