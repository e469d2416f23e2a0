#include "rviz/node_diagnostics.h"

#include <utility>

#include "rviz/session_clock.h"

namespace microinjection {
namespace {

constexpr double kDiagnosticsSilence = 3.5;  // s

}  // namespace

NodeDiagnostics::NodeDiagnostics(std::string name, Handler handler)
    : name_(std::move(name)), handler_(std::move(handler)) {}

void NodeDiagnostics::start(Bus& bus) {
  if (bus_) return;
  bus_ = &bus;
  // Each node reports by itself, within the same millisecond as others.
  reports_ = bus.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 50,
                                                             [this](const auto& delivery) { read(*delivery.message); });
}

bool NodeDiagnostics::isFresh() const { return heard_at_ && sessionNow(*bus_) - *heard_at_ < kDiagnosticsSilence; }

void NodeDiagnostics::read(const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    if (status.name != name_) continue;
    heard_at_ = sessionNow(*bus_);
    if (handler_) handler_(status);
  }
}

}  // namespace microinjection
