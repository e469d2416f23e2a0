#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "rigs/reading_filter.h"
#include "rigs/serial_manipulator.h"
#include "rigs/zaber/zaber_config.h"
#include "rigs/zaber/zaber_protocol.h"

namespace microinjection {

/// Three Zaber axes. Follows set-points by a stream of velocities: the set-point's, and the distance from it times a
/// gain; moves are the device's own, with a speed for each axis that makes the line straight but for the ramps. From
/// firmware 7.25 on a velocity is a move to where it leads in `move_horizon`, renewed in every turn: nothing runs away
/// when the line or this computer is gone. Nearer than that to its travel's end, and with older firmware, it is a
/// velocity that holds until the next one.
///
/// One message is under way at a time, in turn: an axis' velocity when it has changed, the axis' position. An axis
/// without a reference position is a fault: homing moves, so the user has it done (`home: true`, at the start only, or
/// the maker's tool). All axes then home, in the plan's order: one that has its reference may be in another's way.
class ZaberDriver : public SerialManipulator {
 public:
  ZaberDriver(const ZaberConfig& config, std::unique_ptr<Wire> wire);

  ManipulatorAbilities abilities() const override;
  std::optional<Reading> reading() const override;
  bool moving() const override;
  std::optional<Eigen::Vector3d> homingEnds() const override {
    if (!config_.home) return std::nullopt;
    return config_.joints.toJoints(Eigen::Vector3d::Zero());  // an axis counts from its reference position
  }
  void planHoming(const HomingPlan& plan) override { homing_ = plan; }

  const std::string& note() const { return note_; }                 ///< the last warning that is no fault
  double largestCorrection() const { return largest_correction_; }  ///< m, of a carried-on position by a reading
  int malformed() const { return parser_.malformed(); }             ///< messages that were none

 protected:
  void connected() override;
  void begin(bool lost) override;
  void talk(const std::string& bytes) override;
  void goalChanged() override;
  void guardIntervened() override { may_home_ = false; }

 private:
  enum class Kind { kPosition, kVelocity, kSpeed, kMove, kClear, kHome, kStop, kVersion, kLowest, kHighest };
  struct Exchange {
    Kind kind;
    int axis;
    ZaberAddress to;
    long long value;   // microsteps, or units of speed
    double end;        // m, where a velocity ends; NaN: it does not
    std::string text;  // of the command
    int tries;
    double due;  // s of listened(), to be sent (again), or to be answered
    bool sent;
  };
  struct Axis {
    ReadingFilter filter;
    std::optional<double> position;  // m of the device, at `position_time`
    double position_time = 0;        // s
    double heard = 0;                // s of listened(), when it was last told truly
    double velocity = 0;             // m/s, carries the position on
    double end = 0;                  // m, where a move ends; NaN: it does not
    std::optional<long long> told;   // units of speed, of the velocity that the device follows
    bool busy = true;
    double move_speed = 0;                                   // m/s, set for the move
    bool read_since_begin = false, read_since_told = false;  // to move
    bool has_reference = true, cleared = true, homed = false;
    bool still_moves = false;  // it said so after it was told to stop
    int stalls = 0;
    // As the device tells them, for as long as the line is open; microsteps.
    std::optional<bool> moves_have_speeds;
    std::optional<long long> lowest, highest;
  };

  double gain() const;
  double longestAge() const;
  double fastest(int axis) const;
  long long speedData(int axis, double speed) const;
  double expected(int axis, double time) const;
  void handle(const ZaberMessage& message);
  void handleReply(const ZaberMessage& reply);
  void handleRejection(const ZaberMessage& reply);
  void takeFlag(const ZaberMessage& message, int axis);
  void takePosition(const ZaberMessage& reply);
  void checkStall(int axis, bool stands);
  void missedReply();
  void next();
  bool nextOfSession();
  bool nextOfHoming();
  bool nextOfSettings();
  void takeSetting(const Exchange& asked, const ZaberMessage& reply);
  bool nextOfMove();
  void nextInTurn();
  void checkMove();
  void ask(Kind kind, int axis, const std::string& command, long long value = 0, double end = std::nan(""));
  void sendExchange();
  long long velocityData(int axis) const;
  bool nextVelocity(int axis);
  std::optional<long long> endOfVelocity(int axis, long long data) const;
  long long moveSpeedData(int axis) const;
  int axisOf(const ZaberAddress& address) const;
  std::string axisName(int axis) const;

  ZaberConfig config_;
  ZaberParser parser_;
  std::array<Axis, 3> axes_;
  std::optional<Exchange> exchange_;
  double begun_ = 0;      // s, of this session
  bool settled_ = false;  // in this session everything has been read and was at rest
  bool may_home_;         // until everything has been known once, and while the program has not stood still
  std::string setting_;   // that was told last, and has to be told again
  int setting_tries_ = 0;
  HomingPlan homing_;
  int number_ = 0;      // of the last command
  int turn_ = 0;        // 0..5: velocity and position of each axis
  int move_stage_ = 0;  // of a move: 0..2 speeds, 3..5 positions, then under way
  int move_tries_ = 0;
  bool move_done_ = false;
  std::string note_;
  double largest_correction_ = 0;  // m
};

}  // namespace microinjection
