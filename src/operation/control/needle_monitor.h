#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/config_reader.h"
#include "operation/control/contact_detector.h"
#include "operation/control/force_noise.h"
#include "operation/control/puncture_detector.h"

namespace microinjection {

struct DetectionConfig {
  int noise_samples = 300;            ///< at rest, before the needle starts
  double contact_force = 50e-9;       ///< N along the pipette that counts as contact
  double contact_false_rate = 1e-7;   ///< false alarms a sample
  int confirm_samples = 30;           ///< of the second check of a contact, while the needle rests
  double puncture_drop = 0.25;        ///< 1, smallest fall of the force that counts as puncture
  double puncture_false_rate = 1e-8;  ///< false alarms a sample
  int puncture_pause = 30;            ///< samples without detection after a puncture, while the cell springs back

  static DetectionConfig read(ConfigReader& reader);
};

/// Detects contact and puncture from force and motion, by hand and by the controller; measures
/// noise and depth.
class NeedleMonitor {
 public:
  explicit NeedleMonitor(const DetectionConfig& config);

  void reset();  ///< begins anew: noise and offset are measured again
  void rearm();  ///< clears the contact; offset and noise stay
  /// Marks a gap in the force: samples before it are not compared with later ones.
  void skip();

  /// Adds a sample: `force` (N, on the tip) and `tip` (m), both in `world`; `axis`: unit, out of
  /// the cell. The first samples only measure the noise: the needle must rest, out of the cell.
  void step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& force);
  /// Only the tip moves. Each reading of a sensor counts once: as several samples, its noise would have another
  /// distribution than the one whose false alarms are bounded.
  void move(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis);

  bool ready() const { return noise_.ready(); }
  double offset() const { return contact_ ? contact_->offset() : noise_.offset(); }  ///< N, of the force at rest
  double force() const;                       ///< N, along the pipette above the offset, smoothed
  double promptForce() const;                 ///< N, the same of the last few samples
  double peakForce() const { return peak_; }  ///< N, largest magnitude along the pipette
  /// N, along the pipette above the offset, if the last step had a reading.
  const std::optional<double>& reading() const { return reading_; }
  double noise() const { return noise_.deviation(); }  ///< N, standard deviation of a reading; @pre ready()
  bool touched() const { return contact_point_.has_value(); }
  double depth() const {
    return depth_;
  }  ///< m past the contact point; 0 before contact
     /// The same of another tip (m).
  double depthOf(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const {
    return contact_point_ ? (*contact_point_ - tip).dot(axis) : 0;
  }
  double maxDepth() const { return max_depth_; }  ///< m

  /// After contact: empty during the second check, then whether it confirmed the contact.
  std::optional<bool> confirmed() const { return confirmed_; }
  bool punctured() const { return punctured_; }         ///< in the last step
  double forceBefore() const { return force_before_; }  ///< N, crest before the last puncture
  /// Steps and moves to detect a puncture at a force (N, along the pipette above the offset).
  double latencyAt(double force) const { return puncture_ ? puncture_->latency(force) * stride_ : 0; }

 private:
  void confirmContact(double axial);
  void follow(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis);

  DetectionConfig config_;
  ForceNoise noise_;
  std::optional<ContactDetector> contact_;
  std::optional<PunctureDetector> puncture_;
  std::optional<Eigen::Vector3d> contact_point_;  ///< m
  std::optional<double> travel_;                  ///< m, of the tip into the cell, at the last sample
  std::optional<bool> confirmed_;
  int confirmation_samples_ = 0;
  std::optional<double> reading_;  ///< N
  int moves_ = 0;                  ///< since the last step
  double stride_ = 1;              ///< steps and moves for each step, a recent mean
  double confirmation_sum_ = 0;    ///< N
  double depth_ = 0, max_depth_ = 0;
  double peak_ = 0, peak_mean_force_ = 0, force_before_ = 0;
  bool punctured_ = false;
};

}  // namespace microinjection
