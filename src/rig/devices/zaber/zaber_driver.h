#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "rig/devices/answer_times.h"
#include "rig/devices/reading_filter.h"
#include "rig/devices/serial_manipulator.h"
#include "rig/devices/zaber/zaber_config.h"
#include "rig/devices/zaber/zaber_protocol.h"
#include "rig/devices/zaber/zaber_settings.h"

namespace microinjection {

/// Three Zaber axes. Follows set-points by a stream of velocities: the set-point's, and the distance from it times a
/// gain; moves are the device's own, with a speed for each axis that makes the line straight but for the ramps. From
/// firmware 7.25 on a velocity is a move to where it leads in `move_horizon`, renewed in every turn: nothing runs away
/// when the line or this computer is gone. Nearer than that to its travel's end, and with older firmware, it is a
/// velocity that holds until the next one.
///
/// One message is under way at a time, in turn: an axis' velocity when it has changed, the axis' position. A session
/// begins with all warnings of each axis, and a connection with the device's settings: its acceleration and microsteps
/// must be those of the file. How long answers take is measured then, and the turn, the gain and the horizon follow.
///
/// An axis without a reference position is a fault, and no position is told: homing moves, so the user has it done
/// (`home: true`, at the start only, or the maker's tool). A reply shows only its most important flag. Where that may
/// hide a lost reference, the axis is asked for all of them, before its position is taken and then in turn. Warnings
/// that change faster than they can be listed are a fault. All axes home, in the plan's order: one that has its
/// reference may be in another's way.
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

  std::string note() const override;
  double largestCorrection() const { return largest_correction_; }  ///< m, of a carried-on position by a reading
  int malformed() const { return parser_.malformed(); }             ///< messages that were none
  double answerTime() const { return answer_time_; }                ///< s, that an answer takes

 protected:
  void connected() override;
  void begin(bool lost) override;
  void exchange(const std::string& bytes) override;
  void goalChanged() override;
  void guardIntervened() override { may_home_ = false; }
  void stopAsked() override;

 private:
  enum class Kind { kPosition, kVelocity, kSpeed, kMove, kClear, kHome, kStop, kWarnings, kSetting };
  struct Exchange {
    Kind kind;
    int axis;
    ZaberAddress to;
    long long value;   // microsteps, units of speed, or the setting's name
    double end;        // m, where a velocity ends; NaN: it does not
    std::string text;  // of the command
    int tries;
    double due;  // s of listened(), to be sent (again), or to be answered
    bool sent;
    double heard_at, heard_from;  // s of time() and of listened(), when the device has the whole command
  };
  struct Axis {
    ReadingFilter filter;
    std::optional<double> position;  // m of the device, at `position_time`
    double position_time = 0;        // s
    double heard = 0;                // s of listened(), when it was last told truly
    double velocity = 0;             // m/s, carries the position on
    double coasting = 0;             // m, by which a stop in this session left the position uncertain
    double end = 0;                  // m, where a move ends; NaN: it does not
    std::optional<long long> told;   // units of speed, of the velocity that the device follows
    bool busy = true;
    double move_speed = 0;                                     // m/s, set for the move
    bool read_since_begin = false, read_since_report = false;  // to move
    bool cleared = true, homed = false;
    bool still_moves = false;  // it said so after it was told to stop
    int stalls = 0;
    bool has_reference = true;
    std::string shown;   // the flag that may hide WR, when its warnings were listed last; empty: none
    int lists_due = 0;   // lists of its warnings that have to be heard, before anything else of it is believed
    std::string listed;  // the list that has to be told twice
    int lists = 0;       // heard since a position was taken
    ZaberSettings settings;
  };

  double gain() const;
  double horizon() const;
  double exchangeTime() const { return config_.exchangeTime(answer_time_); }
  double turnTime() const;
  double longestAge() const;
  double longestGuess() const;
  double fastest(int axis) const;
  long long speedData(int axis, double speed) const;
  double expected(int axis, double time) const;
  int axisOf(const ZaberAddress& address) const;
  std::string axisName(int axis) const;
  std::string axesNote() const;

  // Replies (zaber_replies.cpp).
  bool isAwaited(const ZaberMessage& reply) const;
  void handle(const ZaberMessage& message);
  void handleReply(const ZaberMessage& reply);
  void takeReply(const Exchange& done, const ZaberMessage& reply);
  void handleRejection(const ZaberMessage& reply);
  void takeFlag(const std::string& flag, int axis);
  void takeWarnings(const Exchange& asked, const ZaberMessage& reply);
  void loseReference(int axis);
  void takePosition(const Exchange& asked, const ZaberMessage& reply);
  void checkStall(int axis, bool stands);
  void missedReply();

  // The begin of a session (zaber_session.cpp).
  bool nextOfSession();
  bool nextOfAxis(int axis);
  bool nextOfHoming();
  void home(int axis);
  bool nextOfSettings();
  void takeSetting(const Exchange& asked, const std::string& data);
  std::string contradiction(int axis) const;
  std::string checkSettings();
  void adaptToAnswers();

  // In turn (zaber_turns.cpp).
  void next();
  bool nextOfWarnings();
  bool nextOfMove();
  void nextInTurn();
  void askAgain();
  void checkMove();
  void ask(Kind kind, int axis, const std::string& command, long long value = 0, double end = std::nan(""));
  void sendExchange();
  long long velocityData(int axis) const;
  bool nextVelocity(int axis);
  bool goalStands() const;
  std::optional<long long> placeOfArrival(int axis) const;
  bool canGoTo(int axis, long long place) const;
  std::optional<long long> endOfVelocity(int axis, long long data) const;
  long long moveSpeedData(int axis) const;

  ZaberConfig config_;
  ZaberParser parser_;
  std::array<Axis, 3> axes_;
  std::optional<Exchange> exchange_;
  AnswerTimes answers_;
  double answer_time_;    // s
  double acceleration_;   // m/s^2, of the slowest axis
  double begun_ = 0;      // s, of this session
  bool lost_ = true;      // nothing was known at the begin of this session
  bool settled_ = false;  // in this session everything has been read and was at rest
  bool may_home_;         // until everything has been known once, or a homing was stopped, or the program stood still
  int setting_tries_ = 0;
  HomingPlan homing_;
  int number_ = 0;       // of the last command
  int turn_ = 0;         // 0..5: velocity and position of each axis
  int asked_again_ = 0;  // the axis whose warnings were asked for last, because it shows one
  int move_stage_ = 0;   // of a move: 0..2 speeds, 3..5 positions, then under way
  int move_tries_ = 0;
  bool move_done_ = false;
  double largest_correction_ = 0;  // m
};

}  // namespace microinjection
