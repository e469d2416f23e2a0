#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/config_reader.h"
#include "operation/control/contact_detector.h"
#include "operation/control/force_noise.h"
#include "operation/control/puncture_detector.h"

namespace microinjection {

struct DetectionConfig {
  int noise_samples = 300;            ///< at rest, before the needle sets out
  double contact_force = 50e-9;       ///< N along the pipette that counts as touch
  double contact_false_rate = 1e-7;   ///< false alarms a sample
  int confirm_samples = 30;           ///< of the second look at a touch, while the needle rests
  double puncture_drop = 0.25;        ///< 1, smallest fall of the force that counts as puncture
  double puncture_false_rate = 1e-8;  ///< false alarms a sample
  int puncture_pause = 30;            ///< samples after a puncture, while the cell springs back, in which none is felt

  static DetectionConfig read(ConfigReader& reader);
};

/// What force and motion tell of the needle and the cell, whoever moves it: noise at rest, touch, depth, puncture.
class NeedleMonitor {
 public:
  explicit NeedleMonitor(const DetectionConfig& config);

  void reset();  ///< as new: noise and offset are measured again
  void rearm();  ///< forgets the touch; offset and noise stay
  /// A gap in the force: what came before is not compared with what comes after.
  void skip();

  /// One sample: `force` (N, on the tip) and `tip` (m), both `world`; `axis`: unit, out of the cell. Before the noise
  /// is known it only measures that: the needle must rest, out of the cell.
  void step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& force);

  bool ready() const { return noise_.ready(); }
  double noise() const { return noise_.deviation(); }                                ///< N
  double offset() const { return contact_ ? contact_->offset() : noise_.offset(); }  ///< N, of the force at rest
  double force() const;                       ///< N, along the pipette above the offset, smoothed
  double peakForce() const { return peak_; }  ///< N, largest along the pipette, either way
  bool touched() const { return touched_at_.has_value(); }
  double depth() const { return depth_; }  ///< m past the touch; 0 without
  /// Of that tip (m), likewise.
  double depthOf(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const {
    return touched_at_ ? (*touched_at_ - tip).dot(axis) : 0;
  }
  double maxDepth() const { return max_depth_; }  ///< m

  /// After a touch: empty while the second look goes on, then whether the touch is confirmed.
  std::optional<bool> confirmed() const { return confirmed_; }
  bool punctured() const { return punctured_; }         ///< in the last step
  double forceBefore() const { return force_before_; }  ///< N, crest before the last puncture
  /// Samples to find a puncture at the present force.
  double latency() const { return puncture_ ? puncture_->latency(force()) : 0; }

 private:
  void confirmContact(double axial);

  DetectionConfig config_;
  ForceNoise noise_;
  std::optional<ContactDetector> contact_;
  std::optional<PunctureDetector> puncture_;
  std::optional<Eigen::Vector3d> touched_at_;  ///< m
  std::optional<double> travel_;               ///< m, of the tip into the cell, at the last sample
  std::optional<bool> confirmed_;
  int looked_ = 0;
  double confirmation_sum_ = 0;  ///< N
  double depth_ = 0, max_depth_ = 0;
  double peak_ = 0, peak_mean_force_ = 0, force_before_ = 0;
  bool punctured_ = false;
};

}  // namespace microinjection
