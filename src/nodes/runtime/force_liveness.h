#pragma once

#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Core>
#include <optional>

#include "base/repetition.h"
#include "cell_microinjection/CellContact.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// Tells an input's force that repeats one value (InputPort::repeats):
///
/// - A sensor's by its noise: with a deviation of 0.65 of the step of its readings, below that of the axial one of
///   config/force_sensor.yaml, 50 are equal once in 1e12, whatever its place between two steps. A sensor whose noise is
///   below that may rest on one reading for long: the session says so (sensor/quiet).
/// - That of a cell before its first membrane has failed by the needle's way in it: a model's force changes with each
///   motion, and 5 um change that of the softest cell (5e-3 N/m) by more than a step of a quiet sensor. Behind a
///   membrane the friction of the shaft may be constant.
///
/// In, with a model: /cell/contact (CellContact)
class ForceLiveness {
 public:
  static constexpr double kReadings = 50;
  static constexpr double kWay = 1e-6, kWayOfSensor = 5e-6;  ///< m

  enum class Source { kModel, kSensor, kQuietSensor };

  /// `port` outlives this.
  ForceLiveness(Cycle& cycle, Input<geometry_msgs::WrenchStamped>& port, Source source);
  ForceLiveness(const ForceLiveness&) = delete;
  ForceLiveness& operator=(const ForceLiveness&) = delete;

  /// Call in each step, before the input is read. `tip`: m, of the needle; empty: unknown. `felt`: by a sensor's force
  /// the needle is in contact with a cell, none of whose membranes has failed. Of a model, the model says that.
  void step(const std::optional<Eigen::Vector3d>& tip, bool felt = false);

 private:
  void receive(const geometry_msgs::WrenchStamped& message);

  Input<geometry_msgs::WrenchStamped>& port_;
  Repetition<Eigen::Vector3d> readings_, on_way_;  ///< N
  std::optional<Eigen::Vector3d> way_from_, tip_;  ///< m, the tip when the force changed last, and now while it presses
  bool presses_ = false;                           ///< by the model, the needle an intact cell
  Subscription contact_;
};

/// The source of the topic /force_sensor/measured_cf.
inline ForceLiveness::Source sensorThatIs(bool quiet) {
  return quiet ? ForceLiveness::Source::kQuietSensor : ForceLiveness::Source::kSensor;
}

}  // namespace microinjection
