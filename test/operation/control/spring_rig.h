#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "operation/control/injection_controller.h"

namespace microinjection {

/// A needle that follows its set-point with a lag while input.rig_hold is empty, in front of an elastic cell whose
/// membrane fails at a force and then drags on the needle; an injector that works when it is asked to.
struct SpringRig {
  static constexpr double kStep = 1e-3;  ///< s
  double period = kStep;                 ///< s, of the controller

  double surface = 28e-6;        ///< m, height of the cell's top
  double stiffness = 0.1;        ///< N/m
  double puncture_force = 1e-6;  ///< N
  double second_force = 0;       ///< N, of a membrane behind that; 0: there is none
  double second_gap = 1e-6;      ///< m, of it before the tip when the first fails
  double break_suction = 0;      ///< Pa, at which the membrane under the tip breaks; 0: it does not
  double left = 0.3;             ///< share of the force that is left when it is through
  double noise = 10e-9;          ///< N rms, along the pipette
  double lag = 2e-3;             ///< s
  bool injector_works = true;
  bool obeys = true;      ///< the injector changes a suction's pressure as it is told
  double full = 0.2e-15;  ///< m^3, of a pulse
  // Of a holder: its line follows within 20 ms, and a cell is held from half of its suction on, until it is lost.
  bool holder_tells = true, cell_is_there = true, somebody_sees = false, sticks = false;
  double holder_pressure = 0;                                           ///< Pa, gauge, in the mouth
  bool needle_tells = true, force_tells = true, injector_tells = true;  ///< else nothing is known of it

  Eigen::Vector3d tip = Eigen::Vector3d(0, 0, 40e-6);
  bool punctured = false, second_punctured = false;
  double punctured_at = 0;     ///< m, depth
  double volume = 0;           ///< m^3
  double deepest = 0;          ///< m, of the tip below the surface
  double largest_force = 0;    ///< N, without noise
  double lowest_pressure = 0;  ///< Pa, of a suction
  InjectionController::Input input;
  std::mt19937 random{1};
  std::optional<Eigen::Vector3d> setpoint;

  double depth() const { return std::max(0.0, surface - tip.z()); }

  double force() {
    const double elastic = stiffness * depth();
    if (elastic >= puncture_force && !punctured) {
      punctured = true;
      punctured_at = depth();
    }
    if (depth() == 0) punctured = second_punctured = false;
    if (!punctured) return elastic;
    const double second = second_force > 0 ? stiffness * std::max(0.0, depth() - punctured_at - second_gap) : 0;
    second_punctured = second_punctured || (second_force > 0 && second >= second_force);
    return left * std::min(elastic, puncture_force) + (second_punctured ? 0 : second);
  }

  void sense(const InjectionController& controller) {
    std::normal_distribution<double> deviate(0, noise);
    const double force = this->force();
    input.needle = tip;
    input.force = Eigen::Vector3d(0, 0, force + (noise > 0 ? deviate(random) : 0));
    const bool asked = controller.pulse() && injector_works;
    const double pressure = asked ? controller.pulse()->pressure : 0;
    lowest_pressure = std::min(lowest_pressure, pressure);
    if (pressure > 0) volume += 1e-15 * period;
    if (break_suction > 0 && pressure <= -break_suction && depth() > 0 && !punctured) {
      punctured = true;
      punctured_at = depth();
    }
    const bool draws = pressure < 0 && obeys;
    input.injector =
        InjectorReport{asked && volume < full, volume, volume >= full, "", draws || pressure > 0 ? pressure : 0, 0};
    if (controller.holderCommand()) senseHolder(controller.holderCommand()->pressure);
    if (!needle_tells) input.needle.reset();
    if (!force_tells) input.force.reset();
    if (!injector_tells) input.injector.reset();
    deepest = std::max(deepest, depth());
    largest_force = std::max(largest_force, force);
  }

  void senseHolder(double wanted) {
    holder_pressure += (1 - std::exp(-period / 20e-3)) * (wanted - holder_pressure);
    const bool holds = cell_is_there && (sticks || holder_pressure < -50);
    input.holder =
        HolderReport{holds ? holder_pressure : 0, holder_pressure, holds ? 0 : 1e-11 * holder_pressure / 1e3};
    input.cell_hold = HoldReport{holds, holds ? "held" : "lost"};
    if (!holder_tells) input.holder.reset();
    if (!somebody_sees) input.cell_hold.reset();
  }

  void move() {
    if (setpoint && input.rig_hold.empty()) tip += (1 - std::exp(-period / lag)) * (*setpoint - tip);
  }

  void step(InjectionController& controller) {
    sense(controller);
    setpoint = controller.step(input, period);
    move();
  }

  /// Until the injection is over, or `limit` steps.
  void run(InjectionController& controller, int limit = 100000) {
    for (int i = 0; i < limit && controller.busy(); ++i) step(controller);
  }
};

}  // namespace microinjection
