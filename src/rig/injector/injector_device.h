#pragma once

#include <cstdint>
#include <string>

namespace microinjection {

/// A pressure on the pipette for a time, instead of the balance pressure.
struct InjectionPulse {
  std::uint64_t id = 0;  ///< of this pulse alone
  double pressure = 0;   ///< Pa, gauge
  double duration = 0;   ///< s
};

struct InjectorReading {
  double pressure = 0;        ///< Pa, gauge, behind the liquid
  double flow = 0;            ///< m^3/s, out of the tip
  double volume = 0;          ///< m^3, left the tip since the last reset; what was drawn in counts negative
  bool busy = false;          ///< a pulse is on its way or under way
  std::uint64_t last_id = 0;  ///< of the last pulse that was done; 0: none
  unsigned pulses = 0;        ///< done since the start
};

/// What pushes liquid through the injection pipette: a model, or a real device behind its protocol. Nothing here waits:
/// commands are noted and carried out by `step`. A command is refused with a reason, or done once.
class InjectorDevice {
 public:
  virtual ~InjectorDevice() = default;

  /// Empty, or why it is refused.
  virtual std::string pulse(const InjectionPulse& pulse) = 0;
  /// The pressure between pulses (Pa, gauge). Empty, or why it is refused.
  virtual std::string setBalance(double pressure) = 0;
  /// Ends the pulse that is on its way or under way: back to the balance pressure. Such a pulse does not count as done.
  /// Without a pulse nothing happens. Empty, or why it is refused: the pulse then goes on.
  virtual std::string stop() = 0;
  /// Clears a fault and the volume.
  virtual void reset() = 0;

  /// `time` (s) never goes back.
  virtual void step(double time) = 0;

  virtual const InjectorReading& reading() const = 0;
  /// Why nothing can be injected; empty when it can.
  virtual std::string fault() const = 0;
};

}  // namespace microinjection
