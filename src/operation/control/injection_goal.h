#pragma once

#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/injection_state.h"

namespace microinjection {

/// The injector's pulse in the state inject.
struct PulseGoal {
  double pressure = 10e3;  ///< Pa, gauge
  double duration = 0.5;   ///< s; 0: no injection
  double volume = 0;       ///< m^3, ends the pulse early; 0: by time only
};

/// What breaks the last membrane of a goal: the needle's force, suction in its bore, or one and, where it fails, the
/// other.
enum class BreakBy { kForce, kSuction, kSuctionThenForce, kForceThenSuction };
const char* toText(BreakBy by);  ///< "force", "suction", "suction_then_force", "force_then_suction"
std::optional<BreakBy> breakByOf(const std::string& name);

/// The suction of a goal, see SuctionRun.
struct SuctionGoal {
  double dent = 10e-6;    ///< m past the touch, or past the membrane before, where the needle rests and draws
  double largest = 2e3;   ///< Pa below the pressure between pulses
  double rate = 500;      ///< Pa/s; 0: all at once, for injectors that cannot change a pulse's pressure
  double time = 1;        ///< s at the largest
  double length = 50e-6;  ///< m from the mouth, of the interface in the image, that ends it
};

/// How a goal holds the cell, see Holding.
struct HoldingGoal {
  double suction = 0;             ///< Pa below the bath; 0: it is held already
  double time = 10;               ///< s, in which it must be held, and let go
  bool release = false;           ///< lets it go when the needle is out
  double release_pressure = 200;  ///< Pa, gauge, that blows it off
  double release_time = 1;        ///< s
};

/// State of the injector.
struct InjectorReport {
  bool busy = false;      ///< a pulse is under way
  double volume = 0;      ///< m^3, delivered since it was reset
  bool done = false;      ///< the last requested pulse ended and was not aborted
  std::string refusal{};  ///< why the last requested pulse does not begin; empty: it was not refused
  double pressure = 0;    ///< Pa, gauge
  double flow = 0;        ///< m^3/s, out of the tip
};

/// Limits of any injection of a cell. A goal beyond them is refused, whatever the guards of the rig
/// allow.
struct InjectionGoalLimits {
  static constexpr int kLayers = 10;         ///< membranes; cells have one or two, stacks of them a few
  static constexpr double kDistance = 1e-3;  ///< m, depth and margin; the largest injected cells are 1 mm wide
  static constexpr double kHoldTime = 600;   ///< s; a longer rest in a cell is a mistake
  static constexpr double kPressure = 1e6;   ///< Pa, gauge; above what injectors of cells deliver (some 0.6 MPa)
  static constexpr double kDuration = 60;    ///< s, as the duration_range of config/injector.yaml
  static constexpr double kVolume = 1e-9;    ///< m^3, the volume of the largest cells
  static constexpr double kSuction = 90e3;   ///< Pa; more is a vacuum
  static constexpr double kBlow = 10e3;      ///< Pa, gauge, that lets a cell go; more shoots it away
};

/// Parameters of one injection that the controller moves. InjectionMotionConfig has the speeds,
/// which depend on rig and cell. No number may be negative: suctions are positive.
struct InjectionGoal {
  bool puncture = true;    ///< false: indent to `depth`, wait `hold_time` and withdraw
  int layers = 1;          ///< membranes to puncture before the injection
  double depth = 40e-6;    ///< m past the contact point; a membrane intact there ends the injection
  double margin = 3e-6;    ///< m past the last puncture, depth of the injection; at most the depth limit
  double hold_time = 0.2;  ///< s at depth before the withdrawal, after an injection
  BreakBy break_by = BreakBy::kForce;
  SuctionGoal suction;
  PulseGoal pulse;
  HoldingGoal holding;

  static InjectionGoal read(ConfigReader& reader);
  /// Checks a received goal. Returns each number that is not finite or beyond InjectionGoalLimits,
  /// with its key and range; empty: none.
  std::string problems() const;
};

/// How an injection ended.
enum class InjectionOutcome {
  kNone,             ///< not ended
  kInjected,         ///< punctured, injected, withdrawn
  kPunctured,        ///< punctured and withdrawn; the goal has no pulse
  kIndented,         ///< indented and withdrawn; the goal has no puncture
  kNoContact,        ///< no cell within the travel limit; withdrawn
  kNotHeld,          ///< the holding pipette did not take the cell; the needle has not moved
  kNotPunctured,     ///< membrane intact at `depth`: held
  kInjectorTimeOut,  ///< the injector did not finish (withdrawn), or was stale (held)
  kNotInjected,      ///< the pulse was refused, aborted or delivered less than its volume; withdrawn
  kPreempted,        ///< by command; withdrawn
  kGuard,            ///< a guard stopped the needle: held, see InjectionResult::reason
  kFault,            ///< the rig is in FAULT
  kDisabled          ///< by command
};
const char* toText(InjectionOutcome outcome);

/// Progress of an injection.
struct InjectionFeedback {
  InjectionState state = InjectionState::kIdle;
  int layer = 0;       ///< next membrane, 1 is the outermost; layers + 1 after the last
  int layers = 0;      ///< of the goal; both are 0 without puncture
  double force = 0;    ///< N, along the pipette, above the offset at rest, mean of 32 samples
  double depth = 0;    ///< m past the contact point; 0 before contact
  double elapsed = 0;  ///< s, since the start
};

struct InjectionResult {
  InjectionOutcome outcome = InjectionOutcome::kNone;
  std::string reason;                    ///< for people; empty after success
  double peak_force = 0;                 ///< N, largest measured along the pipette
  double max_depth = 0;                  ///< m past the contact point
  int punctures = 0;                     ///< membranes
  std::optional<double> puncture_force;  ///< N, along the pipette, before the last puncture
  std::optional<double> puncture_depth;  ///< m past the contact point, at its detection
  double volume = 0;                     ///< m^3, injected
  double duration = 0;                   ///< s
  int false_touches = 0;                 ///< contacts that the second check did not confirm
  double break_suction = 0;              ///< Pa, that broke the last membrane; 0: no suction did
  int false_breaks = 0;                  ///< alarms of a break that were not confirmed
};

}  // namespace microinjection
