#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

/// Which readings of an indentation are kept.
struct SampleHistoryConfig {
  double spacing = 50e-9;  ///< m, of the tip's path: the readings on it become one sample
  double duration = 0.05;  ///< s, longest of a sample: a cell that relaxes changes its force at rest
  int capacity = 160;      ///< samples; when they are full, the nearest neighbours become one

  void read(ConfigReader& reader);
};

/// The path of a tip with the force on it, as means of neighbouring readings. Its length is bounded:
/// the longer the indentation, the coarser the samples.
class SampleHistory {
 public:
  struct Sample {
    double time = 0;                                ///< s, mean
    Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< m, mean
    double force = 0;                               ///< N, mean
    double scatter = 0;                             ///< N^2, sum of the squared deviations from the mean
    int readings = 0;
  };

  explicit SampleHistory(const SampleHistoryConfig& config) : config_(config), spacing_(config.spacing) {}

  /// `tip`: m, `force`: N, of the cell on the tip along the pipette.
  void add(double time, const Eigen::Vector3d& tip, double force);
  /// Forgets what is older than `time` (s) except the newest sample of it.
  void forgetBefore(double time);
  /// Forgets the samples that end after `time` (s).
  void forgetSince(double time);
  void clear();

  const std::vector<Sample>& samples() const { return samples_; }
  /// N, standard deviation of one reading, from those of the same sample; 0 while it is not known.
  double noise() const;

 private:
  void thin();  ///< joins about half of the neighbours, the nearest ones

  SampleHistoryConfig config_;
  double spacing_;  ///< m, present
  std::vector<Sample> samples_;
  double begun_ = 0;                                 ///< s, of the newest sample
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m, same
};

}  // namespace microinjection
