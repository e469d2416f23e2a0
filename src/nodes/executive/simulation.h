#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nodes/executive/executive.h"
#include "session/session.h"

namespace microinjection {

struct SimulationConfig {
  double duration = 0;    ///< s, after which the session ends; 0: when the hand or the injection is done
  double limit = 600;     ///< s, in which hand or injection must be done
  double settling = 0.5;  ///< s after that, for what is still under way
};

struct SimulationResult {
  double simulated = 0, took = 0;     ///< s of the session, s of wall time
  bool done = false;                  ///< the hand, the injection or the duration has ended
  std::string outcome;                ///< of the injection, empty without one
  std::vector<std::string> warnings;  ///< such as a needle that is still in the cell
  std::vector<std::string> failures;  ///< nodes that ended by an error, with it
};

/// Throws ConfigError naming all keys of a session that need a device, a display or a person, which do not
/// exist in virtual time.
void requireSimulable(const Session& session);

/// Runs a session to its end on virtual time. `progress` hears the time of the session (s), about each
/// tenth of a second of wall time. @throws ConfigError when a node does not start
SimulationResult simulate(const Session& session, const SimulationConfig& config,
                          const std::function<void(double time)>& progress = {});

}  // namespace microinjection
