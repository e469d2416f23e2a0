#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>

#include "hardware/devices/joint_axes.h"
#include "hardware/devices/origin_monitor.h"
#include "hardware/devices/position_filter.h"
#include "hardware/devices/reply_times.h"
#include "hardware/devices/serial_manipulator.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {

/// Keys of every device of this kind.
struct MoveByMoveConfig {
  SerialPortConfig port;
  AxisOrder axes;
  JointAxes joints;
  double speed = 1e-3;               ///< m/s, largest along a move
  double segment_time = 0.05;        ///< s, duration of a short move towards a set-point
  double answer_time = 5e-3;         ///< s, reply time of the device
  double reply_timeout = 0.3;        ///< s, until a reply is missing, in addition to the transmission
  double rest_reading_interval = 1;  ///< s, between readings at rest

  double byteTime() const { return 10.0 / port.baud; }  ///< s

 protected:
  /// `speeds` (m/s) and `rest_readings` (s): the device's limits.
  void readCommon(ConfigReader& reader, int default_baud, const Range& speeds, const Range& rest_readings);
};

/// A manipulator that executes one straight move after another. Set-points become short moves, each
/// to the newest set-point. Between readings the position is extrapolated along the move, never
/// past its end, and only until it is due: a position that is no longer confirmed is none.
///
/// A line can change bytes of a command, and no protocol here has a checksum. So the device is
/// checked against the straight line to its goal: a reading beside that line is a fault.
///
/// A device that reports an impossible position was switched off and on, and counts from 0 at its
/// present position. That is a fault, and no position is reported until clearFault() accepts the
/// new coordinates.
class MoveByMove : public SerialManipulator {
 public:
  std::optional<Reading> reading() const final;
  bool moving() const final;

  int malformed() const { return malformed_; }  ///< malformed replies

 protected:
  static constexpr double kSame = 0.5;           ///< counts; an axis at rest changes by less than one
  static constexpr double kHeldReply = 0.02;     ///< s, for which a USB adapter may delay a reply
  static constexpr double kMoveAllowance = 0.5;  ///< s, allowed in addition to 1.25 times the duration of a move
  static constexpr int kTries = 2;               ///< of a move that misses its goal

  struct Move {
    Eigen::Vector3d from, to;  ///< counts
    Eigen::Vector3d goal;      ///< counts, final goal; the move may be a part of the path
    bool follows;              ///< a short move towards a set-point
    double begin, duration;    ///< s, of the rest of the move since `from` was read
  };

  /// The straight way to the goal, which may be travelled in parts, and the start of its next part.
  struct Line {
    Eigen::Vector3d begin, goal, next;  ///< counts
  };

  /// `longest_move`: bytes for a move, including replies.
  MoveByMove(const MoveByMoveConfig& config, std::unique_ptr<Wire> wire, const Link& link, std::size_t longest_move);

  virtual Eigen::Vector3d counts() const = 0;       ///< m, of each of the device's axes
  virtual double arrival() const { return kSame; }  ///< counts from the goal within which an axis has arrived
  virtual double recoveryTime() const = 0;          ///< s, from a failed exchange to a valid position

  void connected() final { reply_times_.clear(); }
  void begin(bool lost) override;
  void onStopSent() override;
  void goalChanged() final { tries_ = 0; }

  /// The abilities that depend on the duration of a turn (s): sending a move, executing it, and
  /// reading its end.
  ManipulatorAbilities abilitiesWith(double turn) const;
  /// Measures the reply time. A slow adapter makes every turn longer, which the abilities report.
  void measure(double sent, std::size_t reply_bytes);
  Eigen::Vector3d goalPosition() const;  ///< counts
  bool isAt(const Eigen::Vector3d& position, const Eigen::Vector3d& goal) const;
  /// Of a displacement (counts): length (m), speed (m/s) for the goal, and largest speed (m/s) at
  /// which no axis exceeds its limit.
  double length(const Eigen::Vector3d& displacement) const { return displacement.cwiseProduct(counts()).norm(); }
  double requestedSpeed(const Eigen::Vector3d& displacement) const;
  double fastestAlong(const Eigen::Vector3d& displacement) const;
  Eigen::Vector3d extrapolatedPosition(double time) const;
  double timeLeft() const { return move_ ? move_->begin + move_->duration - time() : 0; }
  bool isUnderWay() const { return move_ && time() > move_->begin; }  ///< a move was sent, and its end not read yet
  bool isOutdated() const;
  /// Of a position during the move, or where the device stands after an interrupted one: distance
  /// (m) from the line to the goal. 0 without a line.
  double besideTheLine(const Eigen::Vector3d& position) const;
  /// Raises a fault if the device is beside the line, by more than `margin` (m). It is not moved
  /// again: the same bytes would be changed again.
  bool faultBesideTheLine(const Eigen::Vector3d& position, double margin);
  /// The position in a move may be extrapolated for `duration` (s) from now.
  void extrapolateFor(double duration) { extrapolated_until_ = time() + duration; }
  /// The position in a move is not where it was extrapolated to, and unknown until the device rests.
  void forgetPosition() { extrapolated_until_ = -std::numeric_limits<double>::infinity(); }
  void rest(const Eigen::Vector3d& position);
  bool isNewZero(const Eigen::Vector3d& position, double margin) const;
  bool detectNewOrigin(const Eigen::Vector3d& position, double outside, bool new_zero, double margin);

  const MoveByMoveConfig common_;
  PositionFilter filter_;
  ReplyTimes reply_times_;
  double answer_time_;  ///< s, measured, at least that of the file
  OriginMonitor origin_monitor_;
  bool settled_ = false;                     ///< the position has been confirmed
  bool settings_lost_ = false;               ///< of the device, since its position was last valid
  bool origin_lost_ = false;                 ///< the coordinates began anew; until the fault is cleared
  double next_rest_reading_ = 0;             ///< s
  std::optional<Eigen::Vector3d> position_;  ///< counts, the last valid one or where the device was stopped
  std::optional<Move> move_;                 ///< in progress, or ended and not read yet
  std::optional<Line> line_;                 ///< of the last move
  bool interrupted_ = false;                 ///< the last move was, and the device has not been found at rest since
  int tries_ = 0;                            ///< moves that missed their goal
  int malformed_ = 0;

 private:
  double stop_bytes_, longest_move_;
  bool isUnconfirmed() const { return isUnderWay() && (time() > extrapolated_until_ || filter_.isContradicted()); }

  double extrapolated_until_ = 0;  // s
  bool unconfirmed_ = false;       // the position at the last stop was not known, and has not been read since
};

}  // namespace microinjection
