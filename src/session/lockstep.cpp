#include "session/lockstep.h"

#include <set>

#include "base/errors.h"

namespace microinjection {

void requireLockstep(const Session& session) {
  std::vector<std::string> errors;
  const auto refuse = [&](const std::string& key, const std::string& what) {
    errors.push_back(session.places.at(key) + ": clock = lockstep with " + what);
  };
  if (session.hand.present() && !session.hand.isOperator())
    refuse("hand/device",
           "hand/device = " + session.hand.device + ": must be with operator or none, which keep the clock's time");
  if (session.twin && session.sensor.source == "none")
    refuse("twin",
           "twin = true and sensor/source = none: must be with a force sensor, for which the twin waits in each step");
  if (!errors.empty()) throw ConfigError(errors);
}

std::vector<std::string> lockstepParticipants(const SessionPlan& plan) {
  static const std::set<std::string> able = {
      "cell_estimator", "cell_simulator",   "force_sensor", "haptic_bridge",    "injection_controller",  "injector",
      "link_emulator",  "micromanipulator", "operator",     "session_recorder", "teleoperation_follower"};
  std::vector<std::string> names;
  for (const NodePlan& node : plan.nodes)
    if (able.count(node.program) > 0) names.push_back("/" + node.name);
  return names;
}

}  // namespace microinjection
