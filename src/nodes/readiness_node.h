#pragma once

#include <cell_microinjection/LoopState.h>
#include <cell_microinjection/Readiness.h>
#include <diagnostic_msgs/DiagnosticArray.h>

#include <string>
#include <vector>

#include "nodes/bus/diagnostics.h"
#include "operation/readiness/readiness.h"

namespace microinjection {

/// Tells on one topic why a session does not do what it is asked to, in the order in which it is to be mended, and what
/// to do. It only listens: without it the session works as well.
///
/// In: /diagnostics, /needle/loop_state, /controller/loop_state, /haptic/loop_state
/// Out: /session/readiness (latched, twice a second)
///
/// Parameters: see kHelp
class ReadinessNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit ReadinessNode(Bus& bus);

 private:
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  void onLoop(const std::string& node, const cell_microinjection::LoopState& message);
  void publish();

  Bus& bus_;
  Readiness readiness_;
  Publisher<cell_microinjection::Readiness> publisher_;
  std::vector<Subscription> subscriptions_;
  Diagnostics diagnostics_;
  BusHandle timer_;
};

}  // namespace microinjection
