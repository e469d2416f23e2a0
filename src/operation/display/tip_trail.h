#pragma once

#include <Eigen/Core>
#include <deque>

#include "operation/display/cell_members.h"
#include "operation/display/display_scale.h"

namespace microinjection {

/// Where the tip was in the last seconds.
class TipTrail {
 public:
  explicit TipTrail(double duration) : duration_(duration) {}

  /// @param time  s, not decreasing; a step back (a restarted clock) begins anew
  void add(double time, const Eigen::Vector3d& tip);

  /// The way, display units, which fades with age.
  ColouredLines lines(double enlargement = kDisplayScale) const;

 private:
  struct Place {
    double time;          ///< s
    Eigen::Vector3d tip;  ///< m
  };
  double duration_;  ///< s
  double now_ = 0;   ///< s
  std::deque<Place> places_;
};

}  // namespace microinjection
