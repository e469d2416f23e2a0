#include "nodes/readiness_node.h"

#include <algorithm>

#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kPublishPeriod = 0.5;  // s of steady time
constexpr int kDiagnosticsQueue = 100;  // each node reports by itself, within the same millisecond as others

std::vector<std::string> readNodes(const Bus& bus) {
  std::vector<std::string> nodes;
  ConfigReader reader = parameterReader(bus);
  reader.texts("nodes", nodes);
  reader.finish();
  return nodes;
}

cell_microinjection::Hindrance toMessage(const Hindrance& hindrance) {
  cell_microinjection::Hindrance message;
  message.node = hindrance.node;
  message.status = hindrance.status;
  message.level = static_cast<decltype(message.level)>(hindrance.level);
  message.holds = hindrance.holds;
  message.reason = hindrance.reason;
  message.remedy = hindrance.remedy;
  message.section = hindrance.section;
  return message;
}

}  // namespace

const char* const ReadinessNode::kHelp =
    "readiness: why a session does not do what it is asked to, and what to do, on one topic.\n"
    "In: /diagnostics /needle/loop_state /controller/loop_state /haptic/loop_state. Out: /session/readiness.\n"
    "Parameters:\n"
    "  ~nodes  names of the session's nodes: one that says nothing for 3.5 s is silent\n";

ReadinessNode::ReadinessNode(Bus& bus)
    : bus_(bus),
      readiness_(readNodes(bus), Remedies::builtIn()),
      publisher_(bus.advertise<cell_microinjection::Readiness>("session/readiness", 1, true)),
      diagnostics_(bus) {
  subscriptions_.push_back(subscribeGuarded<diagnostic_msgs::DiagnosticArray>(
      bus, "/diagnostics", kDiagnosticsQueue, [this](const auto& message, const auto&) { onDiagnostics(message); },
      StampRule::kAny));
  for (const auto& [topic, node] :
       {std::pair("needle/loop_state", "micromanipulator"), std::pair("controller/loop_state", "injection_controller"),
        std::pair("haptic/loop_state", "haptic_bridge")}) {
    subscriptions_.push_back(subscribeGuarded<cell_microinjection::LoopState>(
        bus, topic, 10, [this, name = std::string(node)](const auto& message, const auto&) { onLoop(name, message); },
        StampRule::kAny));
  }
  diagnostics_.add("readiness", [this](auto& status) {
    const std::size_t count = readiness_.hindrances(bus_.steady().toSec()).size();
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, std::to_string(count) + " reasons on /session/readiness");
    bus_.refusals().report(status);
  });
  timer_ = bus.timer(kPublishPeriod, [this] {
    publish();
    diagnostics_.update();
  });
}

void ReadinessNode::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    const std::size_t colon = status.name.find(": ");
    if (colon == std::string::npos) continue;  // of another program
    const int level = std::clamp<int>(status.level, 0, 2);
    readiness_.hearStatus(status.name.substr(0, colon), status.name.substr(colon + 2),
                          static_cast<Hindrance::Level>(level), status.message, bus_.steady().toSec());
  }
}

void ReadinessNode::onLoop(const std::string& node, const cell_microinjection::LoopState& message) {
  readiness_.hearLoop(node, message.follows ? "" : message.hold_reason, bus_.steady().toSec());
}

void ReadinessNode::publish() {
  const double now = bus_.steady().toSec();
  cell_microinjection::Readiness message;
  message.header.stamp = bus_.now();
  message.ready = readiness_.isReady(now);
  for (const Hindrance& each : readiness_.hindrances(now)) message.hindrances.push_back(toMessage(each));
  publisher_.publish(message);
}

}  // namespace microinjection
