#pragma once

#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/needle_monitor.h"

namespace microinjection {

/// How far two forces may differ before the first membrane has failed.
struct WitnessConfig {
  /// m and N past the touch that one of the two forces has felt, by which the other one must have felt it, too. The
  /// places of the two touches differ by where the scene has the cell, by noise and by latency.
  double depth = 10e-6, force = 0.6e-6;
  double ratio = 5;      ///< of the two forces, once the larger one is past `force`, and both touches are `depth` ago
  double gap = 3e-6;     ///< m, of the tip before the cell in an image, `depth` past a touch
  bool measured = true;  ///< the witness is the sensor's force: it also feels whether a membrane failed

  void read(ConfigReader& reader);
};

/// The force that the controller does not act on: the sensor's while it acts on the prediction, or the reverse. A
/// sensor that is dead, frozen or in another unit, or a cell that is not where the scene has it, is found by their
/// disagreement. One that is late is not: its age is judged where it is received.
class ForceWitness {
 public:
  ForceWitness(const DetectionConfig& detection, const WitnessConfig& config);

  void reset();
  void rearm();
  void skip();

  /// After the controller's monitor; `force` (N, on the tip, `world`): empty without a valid one. `is_new`: it is
  /// another reading than that of the last step.
  void step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const std::optional<Eigen::Vector3d>& force,
            bool is_new = true);
  /// After step() and the controller's monitor `acting` of `force` (N, on the tip, `world`): compares the two forces
  /// where each has a new reading since they were compared last. One that is late is therefore not compared with what
  /// the other one has felt meanwhile. `is_new`: as in step().
  void compare(const NeedleMonitor& acting, const Eigen::Vector3d& force, bool is_new);
  void forgetPairs();  ///< where either force has a gap: what was compared before says nothing of what comes

  /// What an image shows of a tip before its cell.
  struct Image {
    double age = 0;  ///< s since it was exposed
    double gap = 0;  ///< m along the needle, from the cell's undisturbed outline to the tip; negative: deeper
  };
  /// After step() and the controller's monitor `acting`: a touch that an image denies, since before the outline no tip
  /// touches. `dt`: s. An image that shows the tip deeper says nothing: the needle may be above the cell in the view.
  void see(const NeedleMonitor& acting, const std::optional<Image>& image, double dt);

  /// Why the needle must not go on; empty: the two forces agree, or there is no witness. Only before the first
  /// puncture: the membranes of a cell and of its model may fail one after the other.
  std::string disagreement() const;
  double depth() const { return monitor_.depth(); }  ///< m past the touch that it has felt; 0 before
  /// Why the sensor contradicts a puncture: its force has not fallen. Empty: it does not, or feels nothing.
  std::string deniesPuncture() const;

 private:
  /// A reading of each of the two forces, N along the pipette above its offset.
  struct Pair {
    long step;
    double acting, witness;
  };
  Pair meanOfPairs() const;
  std::string differenceOf(const NeedleMonitor& acting) const;

  WitnessConfig config_;
  NeedleMonitor monitor_;
  boost::circular_buffer<Pair> pairs_{32};  ///< the last ones
  long steps_ = 0;
  bool new_acting_ = false, new_witness_ = false;  ///< since the last pair
  std::string difference_;                         ///< of the last pairs
  double axial_ = 0;                               ///< N along the pipette, of the last reading
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero(), axis_ = Eigen::Vector3d::UnitZ();  ///< m; of the last step
  bool heard_ = false;                                                               ///< in the last step
  bool punctured_ = false;     ///< a puncture was felt since the touch
  int since_puncture_ = 0;     ///< steps
  double largest_ = 0;         ///< N, of the smoothed force, since the touch
  double deep_ = 0;            ///< s for which the acting force has felt the touch more than `depth` ago
  std::optional<double> gap_;  ///< m, in an image since then
};

}  // namespace microinjection
