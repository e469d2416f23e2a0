#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "rig/devices/answer_times.h"
#include "rig/devices/axis_order.h"
#include "rig/devices/joint_axes.h"
#include "rig/devices/origin_watch.h"
#include "rig/devices/reading_filter.h"
#include "rig/devices/serial_manipulator.h"
#include "rig/serial/serial_port.h"

namespace microinjection {

/// Keys that every device below has in its file.
struct MoveByMoveConfig {
  SerialPortConfig port;
  AxisOrder axes;
  JointAxes joints;
  double speed = 1e-3;               ///< m/s, largest along a move
  double segment_time = 0.05;        ///< s, that a short move towards a set-point should take
  double answer_time = 5e-3;         ///< s, that the device takes to answer
  double reply_timeout = 0.3;        ///< s, after which an answer is missed, besides the time on the wire
  double rest_reading_interval = 1;  ///< s, between readings at rest

  double byteTime() const { return 10.0 / port.baud; }  ///< s

 protected:
  /// `speeds` (m/s) and `rest_readings` (s) are what the device allows.
  void readCommon(ConfigReader& reader, int default_baud, const Range& speeds, const Range& rest_readings);
};

/// A manipulator that takes one straight move after another. Set-points become short moves, each to the newest
/// set-point. Between readings its position is carried on along the move, never past the move's end.
///
/// A device that reports a place where it cannot be was switched off and on, and counts from 0 where it stands: that is
/// a fault, no position is told, and only clearFault() makes the new coordinates valid.
class MoveByMove : public SerialManipulator {
 public:
  std::optional<Reading> reading() const final;
  bool moving() const final;

  double largestCorrection() const { return largest_correction_; }  ///< m, of a carried-on position by a reading
  int malformed() const { return malformed_; }                      ///< answers that were none

 protected:
  static constexpr double kSame = 0.5;  ///< counts: what stands does not change by one

  struct Move {
    Eigen::Vector3d from, to;  ///< counts
    Eigen::Vector3d goal;      ///< counts, that it is for: it may be a part of the way
    bool follows;              ///< a short one towards a set-point
    double begin, duration;    ///< s, of what is left since `from` was read
  };

  /// `longest_move`: bytes of what a move takes, answers included.
  MoveByMove(const MoveByMoveConfig& config, std::unique_ptr<Wire> wire, const Link& link, std::size_t longest_move);

  virtual Eigen::Vector3d counts() const = 0;       ///< m, of each of the device's axes
  virtual double arrival() const { return kSame; }  ///< counts from its goal at which an axis has arrived
  virtual double recoveryTime() const = 0;          ///< s, from an exchange that went wrong to a true position

  void connected() final { answers_.clear(); }
  void begin(bool lost) override;
  void onStopSent() override;
  void goalChanged() final { tries_ = 0; }

  /// Those that depend on how long a turn takes: a move is said, goes, and is seen to have arrived (s).
  ManipulatorAbilities abilitiesWith(double turn) const;
  /// A slow adapter makes every turn longer; who commands the rig is told of it by its abilities.
  void measure(double sent, std::size_t answer_bytes);
  Eigen::Vector3d goalPlace() const;  ///< counts
  bool isThere(const Eigen::Vector3d& place, const Eigen::Vector3d& goal) const;
  double length(const Eigen::Vector3d& way) const { return way.cwiseProduct(counts()).norm(); }  ///< m, of counts
  double askedSpeed(const Eigen::Vector3d& way) const;    ///< m/s, for the goal, at the end of a way (counts)
  double fastestAlong(const Eigen::Vector3d& way) const;  ///< m/s, at which no axis is faster than it may be
  Eigen::Vector3d extrapolatedPosition(double time) const;
  double timeLeft() const { return move_ ? move_->begin + move_->duration - time() : 0; }
  bool isOutdated() const;
  void corrected(const Eigen::Vector3d& place, const Eigen::Vector3d& expected);
  void rest(const Eigen::Vector3d& place);
  bool isNewZero(const Eigen::Vector3d& place, double margin) const;
  bool beginsAnew(const Eigen::Vector3d& place, double outside, bool new_zero, double margin);

  const MoveByMoveConfig common_;
  ReadingFilter filter_;
  AnswerTimes answers_;
  double answer_time_;  ///< s, as it is measured, not less than in the file
  OriginWatch watch_;
  bool settled_ = false;                     ///< it is known where it is
  bool settings_lost_ = false;               ///< of the device, since it was last known where it is
  bool begun_anew_ = false;                  ///< its coordinates; lasts until the fault is cleared
  double next_rest_reading_ = 0;             ///< s
  std::optional<Eigen::Vector3d> position_;  ///< counts, the last true one or where it was stopped
  std::optional<Move> move_;                 ///< under way, or over and not yet read
  int tries_ = 0;                            ///< moves that ended elsewhere
  int malformed_ = 0;

 private:
  double stop_bytes_, longest_move_;
  double largest_correction_ = 0;  // m
};

}  // namespace microinjection
