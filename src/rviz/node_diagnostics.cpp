#include "rviz/node_diagnostics.h"

#include <utility>

#include "rviz/session_clock.h"

namespace microinjection {
namespace {

constexpr double kDiagnosticsSilence = 3.5;  // s

}  // namespace

NodeDiagnostics::NodeDiagnostics(std::string name, Handler handler)
    : name_(std::move(name)), handler_(std::move(handler)) {}

void NodeDiagnostics::start() {
  if (node_) return;
  node_.emplace();
  node_->setCallbackQueue(&queue_);
  // Each node reports by itself, within the same millisecond as others.
  reports_ = node_->subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 50,
      boost::function<void(const diagnostic_msgs::DiagnosticArray::ConstPtr&)>(
          [this](const auto& message) { read(*message); }));
}

void NodeDiagnostics::poll() { queue_.callAvailable(ros::WallDuration(0)); }

bool NodeDiagnostics::isFresh() const { return heard_at_ && sessionNow() - *heard_at_ < kDiagnosticsSilence; }

void NodeDiagnostics::read(const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    if (status.name != name_) continue;
    heard_at_ = sessionNow();
    if (handler_) handler_(status);
  }
}

}  // namespace microinjection
