#pragma once

#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/injection_state.h"

namespace microinjection {

/// What the injector is asked for in the state inject.
struct PulseGoal {
  double pressure = 10e3;  ///< Pa, gauge
  double duration = 0.5;   ///< s; 0: nothing is injected
  double volume = 0;       ///< m^3 at which the pulse ends early; 0: by time only
};

/// What the injector says of itself.
struct InjectorReport {
  bool busy = false;  ///< a pulse is under way
  double volume = 0;  ///< m^3, delivered since it was reset
  bool done = false;  ///< the last pulse that was asked for is over and was not broken off
};

/// What no injection of a cell is meant to exceed: a goal that does is refused, whatever the guards of the rig allow.
struct InjectionGoalLimits {
  static constexpr int kLayers = 10;         ///< membranes; cells have one or two, stacks of them a few
  static constexpr double kDistance = 1e-3;  ///< m, depth and margin; the largest cells that are injected are 1 mm wide
  static constexpr double kHoldTime = 600;   ///< s; a needle that rests longer in a cell was forgotten there
  static constexpr double kPressure = 1e6;   ///< Pa, gauge; above what injectors of cells deliver (some 0.6 MPa)
  static constexpr double kDuration = 60;    ///< s, as the duration_range of config/injector.yaml
  static constexpr double kVolume = 1e-9;    ///< m^3, as much as such a cell itself
};

/// One injection of the controller's own: what for and how far. How fast is the rig's and the cell's, see
/// InjectionMotionConfig. Nothing may be negative: a pulse that sucks is no injection.
struct InjectionGoal {
  bool puncture = true;    ///< false: indents to `depth` only, waits `hold_time` and withdraws
  int layers = 1;          ///< membranes to go through, one after the other, before the injector works
  double depth = 40e-6;    ///< m past the touch; a membrane that has not given way there ends it
  double margin = 3e-6;    ///< m past where the last membrane gave way, to inject at; never deeper than the depth limit
  double hold_time = 0.2;  ///< s at depth before the withdrawal (after the injection, where there is one)
  PulseGoal pulse;

  static InjectionGoal read(ConfigReader& reader);
  /// Of a goal that came over a topic: each number that is not finite or beyond InjectionGoalLimits, with its key and
  /// what is allowed; empty when it is sound.
  std::string problems() const;
};

/// How an injection ended.
enum class InjectionOutcome {
  kNone,             ///< none yet
  kInjected,         ///< punctured, injected, withdrawn
  kPunctured,        ///< punctured and withdrawn; no injection was asked for
  kIndented,         ///< indented and withdrawn; no puncture was asked for
  kNoContact,        ///< no cell within the travel limit; withdrawn
  kNotPunctured,     ///< at `depth` and not through: held
  kInjectorTimeOut,  ///< the injector did not finish, or was not there; withdrawn
  kNotInjected,      ///< the pulse was broken off, or gave less than its volume; withdrawn
  kPreempted,        ///< by command; withdrawn
  kGuard,            ///< a guard stopped the needle: held, see `reason`
  kFault,            ///< the rig is at fault
  kDisabled          ///< by command
};
const char* toText(InjectionOutcome outcome);

/// For whoever waits.
struct InjectionFeedback {
  InjectionState state = InjectionState::kIdle;
  int layer = 0;       ///< membrane that comes next, 1 is the outermost; layers + 1 when all are behind the needle
  int layers = 0;      ///< of the goal; both are 0 where none is to be punctured
  double force = 0;    ///< N, along the pipette, above the offset at rest, mean of 32 samples
  double depth = 0;    ///< m past the touch; 0 before
  double elapsed = 0;  ///< s, since the start
};

struct InjectionResult {
  InjectionOutcome outcome = InjectionOutcome::kNone;
  std::string reason;                    ///< for people; empty where all went well
  double peak_force = 0;                 ///< N, largest measured along the pipette
  double max_depth = 0;                  ///< m past the touch
  int punctures = 0;                     ///< membranes
  std::optional<double> puncture_force;  ///< N, along the pipette, before the last membrane gave way
  std::optional<double> puncture_depth;  ///< m past the touch, where that was felt
  double volume = 0;                     ///< m^3, injected
  double duration = 0;                   ///< s
  int false_touches = 0;                 ///< that the second look did not confirm
};

}  // namespace microinjection
