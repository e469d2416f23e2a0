#pragma once

#include <optional>

#include "hardware/injector/injector_device.h"
#include "hardware/injector/injector_limits.h"
#include "hardware/injector/pipette_flow.h"

namespace microinjection {

struct InjectorModelConfig {
  double rise_time = 5e-3;  ///< s, time constant of the regulator's first-order response
  double balance = 545;     ///< Pa, gauge, at the start
  double draw_limit = 0;    ///< m^3, of the medium that may be drawn into the tip; 0: any; not read
  PipetteConfig pipette;
  InjectorLimits limits;

  /// Reads its own keys but draw_limit, the section `pipette`, and the limits.
  static InjectorModelConfig read(ConfigReader& reader);
};

/// A pressure regulator with a pipette: p' = (target - p) / rise_time, flow by PipetteFlow.
/// Pressure and volume are integrated exactly, also if a pulse ends within a step, so results do
/// not depend on the step.
///
/// A suction that nobody ends fills the pipette with medium, or, after the break of a membrane, with the cell. So what
/// is drawn in has a limit. When it is reached, a pulse ends and the balance becomes the rest pressure, at which
/// nothing flows. The pressure then still falls off with the regulator's time; that much earlier is the switch, so that
/// exactly the limit is drawn in.
class InjectorModel : public InjectorDevice {
 public:
  explicit InjectorModel(const InjectorModelConfig& config);

  std::string pulse(const InjectionPulse& pulse) override;
  std::string setBalance(double pressure) override;
  std::string adjust(double pressure) override;
  std::string stop() override;
  void reset() override;
  void step(double time) override;
  const InjectorReading& reading() const override { return reading_; }
  std::string fault() const override { return ""; }

  /// Starts a pulse that the caller ends by finish() or stop(). Its duration and the limits do not
  /// apply.
  void open(const InjectionPulse& pulse);
  /// Ends the current pulse as completed.
  void finish();

  /// Why a pressure (Pa) may not be set: it would draw in beyond the limit; empty: it may.
  std::string drawRefusal(double pressure) const;
  double restPressure() const { return flow_.restPressure(); }  ///< Pa, gauge

  /// `flow`: m^3/s, into the tip, that what lies before its mouth lets through, as a cell that is drawn in; empty: the
  /// mouth is free.
  void cover(const std::optional<double>& flow) { covered_flow_ = flow; }
  double resistance() const { return flow_.resistance() * clogging_; }  ///< Pa s/m^3, of the pipette

  /// Injects a fault: the tip's flow resistance is `factor` times that of a clean tip. @pre factor
  /// >= 1
  void clog(double factor) { clogging_ = factor; }

 private:
  double poured(double target, double dt) const;
  double flowNow() const { return covered_flow_ ? -*covered_flow_ : flow_.flow(reading_.pressure, clogging_); }
  double coast() const;
  double crossing(double target) const;
  double untilLimit(double target) const;
  void follow(double target, double dt);
  void advance(double target, double dt);

  InjectorModelConfig config_;
  PipetteFlow flow_;
  double balance_;  ///< Pa
  double clogging_ = 1;
  std::optional<double> covered_flow_;  ///< m^3/s
  std::optional<InjectionPulse> pulse_;
  double left_ = 0;  ///< s, remaining time of the pulse
  double time_ = 0;  ///< s
  bool begun_ = false;
  InjectorReading reading_;
};

}  // namespace microinjection
