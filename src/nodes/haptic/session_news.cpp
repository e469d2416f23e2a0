#include "nodes/haptic/session_news.h"

#include <cstdio>

namespace microinjection {
namespace {

std::string describe(const cell_microinjection::CellState& cell) {
  char text[80];
  if (cell.inside) {
    std::snprintf(text, sizeof text, ", %u layers through, %.1f um inside", cell.layers_punctured,
                  1e6 * cell.insertion_depth);
  } else if (cell.in_contact) {
    std::snprintf(text, sizeof text, ", touching, %.1f um deep", 1e6 * cell.indentation);
  } else {
    return ", off the cell";
  }
  return text;
}

}  // namespace

SessionNews::SessionNews(Cycle& cycle) {
  controller_ = cycle.node().subscribe<cell_microinjection::OperatingState>(
      "controller/operating_state", 10,
      [this](const cell_microinjection::OperatingStateConstPtr& message) { state_ = message->state; });
  cell_ = cycle.node().subscribe<cell_microinjection::CellState>(
      "cell/state", 1,
      [this](const cell_microinjection::CellStateConstPtr& message) { contact_ = describe(*message); });
  diagnostics_ = cycle.node().subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { hear(*message); });
}

std::string SessionNews::text() const { return state_ + contact_; }

void SessionNews::hear(const diagnostic_msgs::DiagnosticArray& diagnostics) {
  for (const auto& status : diagnostics.status) {
    if (status.name == "haptic_bridge: loop") held_ = status.level == 0 ? "" : status.message;
    if (status.name == "injection_controller: control" && status.level != 0 && held_.empty()) held_ = status.message;
  }
}

}  // namespace microinjection
