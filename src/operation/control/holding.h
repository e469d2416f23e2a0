#pragma once

#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/injection_goal.h"

namespace microinjection {

/// When the holding pipette has a cell. A cell that closes the mouth stops the flow; nothing else of a real holder
/// tells.
struct HoldingConfig {
  double pressure_error = 0.1;  ///< of the wanted pressure, within which it is reached
  double leak = 2e-12;          ///< m^3/s through the mouth, above which the seal is open: an open one has some 1e-11
  double rest = 0.3;            ///< s, for which both must last

  static HoldingConfig read(ConfigReader& reader);
};

/// State of the holder.
struct HolderReport {
  double pressure = 0;    ///< Pa, gauge, in the mouth
  double line = 0;        ///< Pa, gauge, behind the pipette: an open mouth has none
  double flow = 0;        ///< m^3/s, out of the mouth
  std::string problem{};  ///< why it does not follow; empty: it does
};

/// A pressure for the mouth of the holding pipette.
struct HolderCommand {
  int number = 0;       ///< of the commands, from 1: the same pressure may be asked for again
  double pressure = 0;  ///< Pa, gauge
};

/// How the cell is held, where somebody sees it: the simulator of the cell, or a camera.
struct HoldReport {
  bool held = false;   ///< it does not slip either
  std::string mode{};  ///< for people: "slipping", "lost"
};

/// Takes a cell with the holding pipette, watches whether it stays there, and lets it go. It commands the pressure in
/// its mouth, and no motion.
///
///               take                 pressure reached, sealed, for `rest`
///     idle -----------------> taking ------------------------------------> held
///      ^                        |   within HoldingGoal::time, else failed     |
///      '------------------- releasing <-------------------------------- release
///        no suction any more for release_time, and nobody sees the cell held: then no pressure
///
/// A pressure that has been commanded stays, whatever happens: what lets go of a cell tears it where a needle is in it.
class Holding {
 public:
  enum class Phase { kIdle, kTaking, kHeld, kReleasing, kFailed };

  explicit Holding(const HoldingConfig& config) : config_(config) {}

  void take(const HoldingGoal& goal) { begin(Phase::kTaking, goal, -goal.suction); }
  void release(const HoldingGoal& goal) { begin(Phase::kReleasing, goal, goal.release_pressure); }
  /// Advances by dt (s). Empty: the holder does not tell; nobody sees the cell.
  void step(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell, double dt);

  Phase phase() const { return phase_; }
  /// Why the cell was not taken, or not let go; empty: it was.
  const std::string& failure() const { return failure_; }
  /// The last pressure that was asked for; empty: none was.
  const std::optional<HolderCommand>& command() const { return command_; }
  /// Why the needle must not go on: the cell is not held. Empty: it is, or nobody can tell.
  const std::string& loss() const { return loss_; }

 private:
  void ask(double pressure);
  void begin(Phase phase, const HoldingGoal& goal, double pressure);
  static std::string unreached(const std::optional<HolderReport>& holder);
  bool isSealed(const HolderReport& holder, const std::optional<HoldReport>& cell) const;
  void judge(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell);
  void stepTaking(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell, double dt);
  void stepReleasing(const std::optional<HolderReport>& holder, const std::optional<HoldReport>& cell, double dt);

  HoldingConfig config_;
  HoldingGoal goal_;
  Phase phase_ = Phase::kIdle;
  std::optional<HolderCommand> command_;
  double time_ = 0, rested_ = 0;  ///< s, of the phase; since it was reached
  std::string failure_, loss_;
};

}  // namespace microinjection
