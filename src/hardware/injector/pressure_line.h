#pragma once

#include <limits>

#include "base/config_reader.h"
#include "hardware/injector/pipette_flow.h"

namespace microinjection {

/// The tube between a pressure source and the holding pipette. Defaults are illustrative: 1 m of a tube of 0.5 mm
/// width, filled with light mineral oil (30 mPa s), and a bubble of air of 1 uL.
struct PressureLineConfig {
  double rise_time = 0.05;  ///< s, time constant of the source: of its regulator, or of the syringe's piston; not read
  double syringe_compliance = 0;   ///< m^3/Pa, of the air in a syringe: its volume over 0.1 MPa; 0: a regulator
  double tube_resistance = 2e13;   ///< Pa s/m^3: 8 viscosity length / (pi radius^4)
  double tube_compliance = 1e-14;  ///< m^3/Pa, of wall, liquid and bubbles, at the pipette's end of the tube

  /// The tube's time constant must be at least 10 us: nothing in a tube is faster.
  static PressureLineConfig read(ConfigReader& reader);
};

struct PressureLineReading {
  double source = 0;   ///< Pa, gauge, at the source
  double pipette = 0;  ///< Pa, gauge, at the pipette's end of the tube
  double mouth = 0;    ///< Pa, gauge, in the mouth
  double flow = 0;     ///< m^3/s, out of the mouth
  double volume = 0;   ///< m^3, out of the mouth since the last reset
};

/// What closes the mouth.
struct MouthSeal {
  double resistance = std::numeric_limits<double>::infinity();  ///< Pa s/m^3, of the gap to the dish; 0: open
  double inflow = 0;  ///< m^3/s, into the mouth beside the gap's flow: of a tongue that is drawn in
};

/// Pressure and flow of a holding pipette: source -> tube -> pipette -> mouth -> gap under the cell -> dish.
///
///     source p_s  --[tube_resistance R]--+-- p --[pipette R_p]-- p_m --[gap R_g]-- dish
///        |                               |
///     syringe_compliance C_s      tube_compliance C
///
///     d'   = (target - d) / rise_time            d: what the piston's place, or the regulator, stands for, Pa
///     p_s' = d' - (p_s - p) / (R C_s)            without a syringe p_s = d
///     p'   = (p_s - p) / (R C) - q / C
///     q    = (p - rest - R_g inflow) / (R_p + R_g),  q = -inflow with a sealed mouth
///     p_m  = p - capillary pressure - R_p q
///
/// A cell that is held needs no flow, so what decides how fast a suction acts, and how long it lasts when the source is
/// lost, is the compliance behind the tube and not the pipette. A regulator feeds a leak for ever, a syringe loses its
/// suction through it: therefore both. The equations are linear in the pressures, so that a step is exact (by the
/// exponential of their matrix), of any length, while target and seal stay what they are.
class PressureLine {
 public:
  /// `pressure`: Pa, gauge, at the start, in the whole line.
  PressureLine(const PressureLineConfig& config, const PipetteConfig& pipette, double pressure);

  /// Pa, gauge, that the source is to have. A syringe's piston moves by what is missing now.
  void setTarget(double pressure);
  /// Pa, gauge, that the source has: of a real one.
  void setSource(double pressure);
  void setSeal(const MouthSeal& seal);
  void reset() { reading_.volume = 0; }
  /// `time` (s) never decreases.
  void step(double time);

  const PressureLineReading& reading() const { return reading_; }
  double target() const { return target_; }  ///< Pa, gauge

 private:
  void updateMouth();

  PressureLineConfig config_;
  PipetteFlow flow_;
  double capillary_;  ///< Pa
  MouthSeal seal_;
  double target_;    ///< Pa
  double driven_;    ///< Pa, d above
  double piston_;    ///< Pa, that `driven_` goes to
  double time_ = 0;  ///< s
  bool begun_ = false;
  PressureLineReading reading_;
};

}  // namespace microinjection
