#include "nodes/bus/diagnostics.h"

#include <cmath>
#include <vector>

#include "base/errors.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

Diagnostics::Diagnostics(Bus& bus)
    : bus_(bus), publisher_(bus.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10)) {
  const YAML::Node period = bus.parameter("~diagnostic_period");
  if (!period.IsNull() && !YAML::convert<double>::decode(period, period_)) period_ = 0;
  if (!(period_ > 0))
    throw ConfigError(bus.name() + ": diagnostic_period = " + period.as<std::string>("") +
                      ": must be a number above 0");
}

diagnostic_updater::DiagnosticStatusWrapper Diagnostics::run(const DiagnosticTaskInternal& task) const {
  diagnostic_updater::DiagnosticStatusWrapper status;
  status.hardware_id = "none";
  status.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  status.message = "no message was set";
  task.run(status);  // sets the name of the task
  status.name = bus_.name().substr(1) + ": " + status.name;
  return status;
}

bool Diagnostics::update() {
  const ros::Time now = bus_.now();
  if (updated_.isZero()) updated_ = now;
  if (std::abs(secondsBetween(updated_, now)) < period_) return false;
  updated_ = now;
  std::vector<diagnostic_msgs::DiagnosticStatus> statuses;
  for (const DiagnosticTaskInternal& task : getTasks()) statuses.push_back(run(task));
  publish(statuses);
  return true;
}

void Diagnostics::publish(const std::string& name) {
  for (const DiagnosticTaskInternal& task : getTasks()) {
    if (task.getName() == name) publish({run(task)});
  }
}

void Diagnostics::publish(const std::vector<diagnostic_msgs::DiagnosticStatus>& statuses) {
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp = bus_.now();
  message.status = statuses;
  publisher_.publish(message);
}

}  // namespace microinjection
