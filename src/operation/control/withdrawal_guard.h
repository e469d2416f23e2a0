#pragma once

#include <string>

#include "operation/control/guards.h"

namespace microinjection {

/// By hand, past a limit of force or depth the needle may only be withdrawn. A rule of one direction rectifies: while a
/// noisy force crosses its limit again and again, what the hand moves out is followed and what it moves in is not, and
/// the needle climbs out of the cell without anybody's wish. Therefore
///
/// - the rule ends only once force and depth have stayed well below their limits for a while (hysteresis);
/// - of the motion that it refuses, up to a play is owed: motion out pays it back before it moves the needle. A hand or
///   a needle that trembles by less than the play moves nothing. What is owed stays small, so that the needle neither
///   catches up when the membrane fails nor follows a withdrawing hand late;
/// - the way out under one limit is bounded: a force that stays while the needle is withdrawn by more than depth_limit
///   is not that of the cell.
class WithdrawalGuard {
 public:
  explicit WithdrawalGuard(const GuardConfig& config);

  /// Begins anew: no limit, nothing owed.
  void reset();
  /// The way out counts anew: the operator has seen the reason.
  void forgive() { withdrawn_ = 0; }

  /// Advances by dt (s), with the force (N), the pipette's axis and the depth (m past the touch) of this step. Returns
  /// whether a limit has begun to hold in it.
  bool step(const Eigen::Vector3d& force, const Eigen::Vector3d& axis, double depth, double dt);

  /// Whether a needle that is `behind` (m) its set-point, on the way in, is so by more than its readings tremble: then
  /// the set-point has to go back to it when a limit begins.
  bool lags(double behind) const { return behind > kReadingNoise * play_; }

  bool active() const { return !reason_.empty(); }
  const std::string& reason() const { return reason_; }  ///< the limit, as it was last exceeded; empty: none
  /// The share of the hand's motion along the axis (m, out of the cell) that the needle follows.
  double followed(double motion);
  /// The needle's set-point was moved out by this (m). Returns why it must go no further; empty: it may.
  std::string withdraw(double way);

 private:
  static constexpr double kReadingNoise = 0.2;

  std::string beyond(const GuardConfig& limits, const Eigen::Vector3d& force, const Eigen::Vector3d& axis,
                     double depth) const;

  GuardConfig config_, lower_;  ///< limits, and those below which a limit ends
  double play_;                 ///< m
  std::string reason_;
  double below_ = 0;      ///< s, since force and depth are below
  double owed_ = 0;       ///< m, in [0, play_]
  double withdrawn_ = 0;  ///< m, under this limit
};

}  // namespace microinjection
