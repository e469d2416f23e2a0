#pragma once

#include <cstdint>
#include <string>

namespace microinjection {

/// A pressure on the pipette for a limited time, instead of the balance pressure.
struct InjectionPulse {
  std::uint64_t id = 0;  ///< unique for each pulse
  double pressure = 0;   ///< Pa, gauge
  double duration = 0;   ///< s
};

struct InjectorReading {
  double pressure = 0;        ///< Pa, gauge, behind the liquid
  double flow = 0;            ///< m^3/s, out of the tip
  double volume = 0;          ///< m^3, out of the tip since the last reset; liquid drawn in counts negative
  double drawn = 0;           ///< m^3, of the medium that is in the tip; what is pushed out is the medium first
  double interface = 0;       ///< m, from the mouth to where the medium ends and the filling begins
  bool limited = false;       ///< draw_limit is reached: the balance is the rest pressure
  bool busy = false;          ///< a pulse is pending or in progress
  std::uint64_t last_id = 0;  ///< of the last completed pulse; 0: none
  unsigned pulses = 0;        ///< completed since the start
};

/// Interface of the pressure source of the injection pipette: a model, or the driver of a real
/// device. No function blocks: a command is stored, and `step` executes it. A command is either
/// refused with a reason, or executed once.
class InjectorDevice {
 public:
  virtual ~InjectorDevice() = default;

  /// Returns an empty text, or the reason for the refusal.
  virtual std::string pulse(const InjectionPulse& pulse) = 0;
  /// Sets the pressure between pulses (Pa, gauge). Returns an empty text, or the reason for the
  /// refusal.
  virtual std::string setBalance(double pressure) = 0;
  /// Changes the pressure (Pa, gauge) of the pulse under way, as in a suction that grows. Returns an empty text, or the
  /// reason for the refusal; the pulse then continues as it was.
  virtual std::string adjust(double /*pressure*/) { return "it cannot change the pressure of a pulse under way"; }
  /// Ends a pending or current pulse and returns to the balance pressure. Such a pulse does not
  /// count as completed. Without a pulse it has no effect. Returns an empty text, or the reason for
  /// the refusal; the pulse then continues.
  virtual std::string stop() = 0;
  /// Clears a fault, the volume and what was drawn in: the pipette counts as filled up to its mouth.
  virtual void reset() = 0;

  /// `time` (s) never decreases.
  virtual void step(double time) = 0;

  virtual const InjectorReading& reading() const = 0;
  /// The reason why injection is impossible; empty if it is possible.
  virtual std::string fault() const = 0;
};

}  // namespace microinjection
