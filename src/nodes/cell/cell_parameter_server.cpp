#include "nodes/cell/cell_parameter_server.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <sstream>

#include "base/errors.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kLargestAge = 1;  ///< s: an older message is of another time, and perhaps of another cell

std::vector<CellParameter> pairs(const std::vector<std::string>& names, const std::vector<double>& values) {
  if (names.empty()) throw ConfigError("name: is empty; must have at least one parameter");
  if (names.size() != values.size()) {
    throw ConfigError("value: has " + std::to_string(values.size()) + " numbers; must have one for each of the " +
                      std::to_string(names.size()) + " names");
  }
  std::vector<CellParameter> parameters;
  for (std::size_t i = 0; i < names.size(); ++i) parameters.push_back({names[i], values[i]});
  return parameters;
}

/// Removes the height from the parameters, of which the last one counts.
std::optional<double> takeHeight(std::vector<CellParameter>& parameters, double highest) {
  std::optional<double> height;
  for (auto it = parameters.begin(); it != parameters.end();) {
    if (it->name != PlacedCell::kName) {
      ++it;
      continue;
    }
    if (!(std::abs(it->value) <= highest)) {
      std::ostringstream message;
      message << "height = " << it->value << " m: must be within " << highest << " m";
      throw ConfigError(message.str());
    }
    height = it->value;
    it = parameters.erase(it);
  }
  return height;
}

std::string describeHeight(double height) {
  char text[60];
  std::snprintf(text, sizeof(text), "%.3g um above its place in the scene", 1e6 * height);
  return text;
}

}  // namespace

CellParameterServer::CellParameterServer(MemberChange* change, const std::string& unchangeable, PlacedCell& place,
                                         double radius, Cycle& cycle)
    : bus_(cycle.bus()),
      changed_(cycle.bus().advertise<cell_microinjection::CellParameters>("cell/parameters", 10)),
      change_(change),
      unchangeable_(unchangeable),
      place_(place),
      highest_(PlacedCell::kHighest * radius) {
  using cell_microinjection::CellParameters;
  using cell_microinjection::SetCellParameters;
  const Serving serving = cycle.bus().isVirtual() ? Serving::kSampled : Serving::kOwnThread;
  subscription_ = subscribeGuarded(cycle.bus(), "cell/set_parameters", 1, &CellParameterServer::receive, this,
                                   StampRule::kTimely, serving);
  service_ = cycle.bus().advertiseService<SetCellParameters>(
      "~set_cell_parameters",
      [this](const SetCellParameters::Request& request, SetCellParameters::Response& response) {
        call(request, response);
        return true;
      },
      serving);
  cycle.diagnostics().add("cell parameters", [this](auto& status) { report(status); });
}

void CellParameterServer::receive(const cell_microinjection::CellParameters& message) {
  const double age = message.header.stamp.isZero() ? 0 : secondsBetween(message.header.stamp, bus_.now());
  if (age > kLargestAge) throw ConfigError("its stamp is " + std::to_string(age) + " s old; must be at most 1 s");
  change(message.name, message.value);
}

void CellParameterServer::call(const cell_microinjection::SetCellParameters::Request& request,
                               cell_microinjection::SetCellParameters::Response& response) {
  try {
    response.message = change(request.name, request.value);
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
}

std::string CellParameterServer::change(const std::vector<std::string>& names, const std::vector<double>& values) {
  std::vector<CellParameter> parameters = pairs(names, values);
  const std::optional<double> height = takeHeight(parameters, highest_);
  std::string outcome = parameters.empty() ? "" : changeCell(parameters);
  if (height) {
    place_.moveTo(*height);
    outcome += (outcome.empty() ? "" : "; ") + describeHeight(*height);
  }
  cell_microinjection::CellParameters changed;
  changed.header.stamp = bus_.now();
  changed.name = names;
  changed.value = values;
  changed_.publish(changed);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++changes_;
  return outcome_ = outcome;
}

std::string CellParameterServer::changeCell(const std::vector<CellParameter>& parameters) {
  if (!change_) throw ConfigError("the cell cannot change while it is served: " + unchangeable_);
  return change_->change(parameters);
}

/// Refused messages are in the diagnostics of the inputs.
void CellParameterServer::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock) return status.summary(diagnostic_msgs::DiagnosticStatus::OK, "are changing");
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, changes_ > 0 ? outcome_ : "as at the start");
  status.add("changes", changes_);
}

}  // namespace microinjection
