#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// One axis with backlash, as a play operator (Prandtl): the tip rests until the motor has crossed
/// the play, then follows half of the backlash behind it. The tip is anchor - side * backlash / 2.
struct PlayAxis {
  double anchor = 0;  ///< m, motor position at which the tip last moved
  int side = 1;       ///< +1: it last moved upwards, -1: downwards

  /// The motor goes from `from` to `to` (m). `half` (m): half of the backlash. A slightly negative
  /// one, as a fit may give it, stays continuous: the tip then leads.
  void move(double from, double to, double half);
  double tip(double half) const { return anchor - side * half; }  ///< m
};

/// Where the backlash leaves the tip. It starts unknown: each axis holds the interval of places
/// that agree with the moves so far. A move through the whole play makes it a point.
///
/// A place of the tip is given as the position (m) of a manipulator without backlash, in the
/// manipulator's axes.
class Play {
 public:
  /// `backlash` (m) of each axis; negative ones count as 0. `position` (m): where the motors are.
  Play(const Eigen::Vector3d& backlash, const Eigen::Vector3d& position);

  void moveTo(const Eigen::Vector3d& position);  ///< m, of the motors; in one straight move
  bool known(int axis) const;                    ///< the interval is a point
  bool known() const { return known(0) && known(1) && known(2); }
  Eigen::Vector3d tip() const { return 0.5 * (low_ + high_); }  ///< m, middle of the interval
  const Eigen::Vector3d& position() const { return position_; }
  const Eigen::Vector3d& backlash() const { return backlash_; }

  /// Motor positions (m), in order, that bring the tip to `tip` (m). It is one position where the
  /// play is known. An axis whose play is unknown comes from below: a first position lies far
  /// enough below the last one. An axis that need not move keeps its motor.
  std::vector<Eigen::Vector3d> commandFor(const Eigen::Vector3d& tip) const;

 private:
  Eigen::Vector3d backlash_, position_, low_, high_;  ///< m
};

}  // namespace microinjection
