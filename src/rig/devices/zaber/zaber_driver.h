#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "rig/devices/position_filter.h"
#include "rig/devices/reply_times.h"
#include "rig/devices/serial_manipulator.h"
#include "rig/devices/zaber/zaber_config.h"
#include "rig/devices/zaber/zaber_protocol.h"
#include "rig/devices/zaber/zaber_settings.h"

namespace microinjection {

/// Driver of three Zaber axes. It follows set-points by a stream of velocities: the set-point's,
/// plus the distance from it times a gain. Moves are the device's own, with a speed for each axis
/// that makes the path straight except for the ramps. From firmware 7.25 on a velocity is a move to
/// its end in `move_horizon`, renewed in every turn, so the axes stop if the line or this computer
/// fails. Near the end of travel, and with older firmware, it is a velocity that continues until
/// the next one.
///
/// One message at a time, in turn: an axis' velocity if it has changed, and the axis' position. A
/// session begins with all warnings of each axis, and a connection with the device's settings,
/// whose acceleration and microsteps must be those of the file. The reply time is measured then,
/// and turn, gain and horizon are adapted to it.
///
/// Two replies to one command (by its number) that differ are those of two devices with one address, which
/// would both move: a fault.
///
/// An axis without a reference position is a fault, and no position is reported. Homing moves the
/// axes, so it needs the user's consent (`home: true`, at the start only) or the maker's tool. A
/// reply shows only its most important flag. If that may hide a lost reference, the axis is asked
/// for all flags, before its position is used and then in turn. Warnings that change faster than
/// they can be listed are a fault. All axes home, in the plan's order, since an axis that has its
/// reference may be in another's path.
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
  int malformed() const { return parser_.malformed(); }  ///< malformed messages

 protected:
  void connected() override;
  void begin(bool lost) override;
  void exchange(const std::string& bytes) override;
  void goalChanged() override;
  void guardIntervened() override { may_home_ = false; }
  void onStopCommand() override;

 private:
  enum class Kind { kPosition, kVelocity, kSpeed, kMove, kClear, kHome, kStop, kWarnings, kSetting };
  struct Exchange {
    Kind kind;
    int axis;
    ZaberAddress to;
    long long value;   // microsteps, units of speed, or the setting's name
    double end;        // m, end of a velocity; NaN: none
    std::string text;  // of the command
    int tries;
    double due;  // s of activeTime(), for (re)sending or for the reply
    bool sent;
    double delivered_time, delivered_active_time;  // s of time() and of activeTime(), when the device has received all
  };
  struct Axis {
    PositionFilter filter;
    std::optional<double> position;          // m of the device, at `position_time`
    double position_time = 0;                // s
    double last_read = 0;                    // s of activeTime(), of the last accepted reading
    double velocity = 0;                     // m/s, for the extrapolation of the position
    double coasting = 0;                     // m, uncertainty of the position by a stop in this session
    double end = 0;                          // m, end of a move; NaN: none
    std::optional<long long> sent_velocity;  // units of speed, of the velocity that the device follows
    bool busy = true;
    double move_speed = 0;  // m/s, set for the move
    bool read_since_begin = false,
         read_since_command = false;  // since the start of the session, the last motion command
    bool cleared = true, homed = false;
    bool reports_motion = false;  // reported after a stop
    int stalls = 0;
    bool has_reference = true;
    std::string shown_flag;  // the flag in the last list of warnings that may hide WR; empty: none
    int lists_required = 0;  // lists of its warnings that are required before any other reply
    std::string last_list;   // the list that must be repeated
    int lists = 0;           // received since the last position
    ZaberSettings settings;
  };

  double gain() const;
  double horizon() const;
  double exchangeTime() const { return config_.exchangeTime(answer_time_); }
  double turnTime() const;
  double longestAge() const;
  double longestExtrapolation() const;
  double fastest(int axis) const;
  long long speedData(int axis, double speed) const;
  double expected(int axis, double time) const;
  int axisOf(const ZaberAddress& address) const;
  std::string axisName(int axis) const;
  std::string axesNote() const;

  // Replies (zaber_replies.cpp).
  bool isOfTwin(const ZaberMessage& reply);
  bool isExpectedReply(const ZaberMessage& reply) const;
  void handle(const ZaberMessage& message);
  void handleReply(const ZaberMessage& reply);
  void applyReply(const Exchange& done, const ZaberMessage& reply);
  void handleRejection(const ZaberMessage& reply);
  void handleFlag(const std::string& flag, int axis);
  void handleWarnings(const Exchange& request, const ZaberMessage& reply);
  void loseReference(int axis);
  void handlePosition(const Exchange& request, const ZaberMessage& reply);
  void checkStall(int axis, bool unchanged);
  void missedReply();

  // Start of a session (zaber_session.cpp).
  bool nextOfSession();
  bool nextOfAxis(int axis);
  bool nextOfHoming();
  void home(int axis);
  bool nextOfSettings();
  void handleSetting(const Exchange& request, const std::string& data);
  std::string settingsMismatch(int axis) const;
  std::string checkSettings();
  void adaptToReplyTime();

  // In turn (zaber_turns.cpp).
  void next();
  bool nextOfWarnings();
  bool nextOfMove();
  void nextInTurn();
  void requestWarningsAgain();
  void checkMove();
  void request(Kind kind, int axis, const std::string& command, long long value = 0, double end = std::nan(""));
  void sendExchange();
  long long velocityData(int axis) const;
  bool nextVelocity(int axis);
  bool goalAtRest() const;
  std::optional<long long> arrivalPosition(int axis) const;
  bool canGoTo(int axis, long long position) const;
  std::optional<long long> endOfVelocity(int axis, long long data) const;
  long long moveSpeedData(int axis) const;

  ZaberConfig config_;
  ZaberParser parser_;
  std::array<Axis, 3> axes_;
  std::optional<Exchange> exchange_;
  std::optional<ZaberMessage> answer_;  // the last expected reply, of this session
  ReplyTimes reply_times_;
  double answer_time_;    // s
  double acceleration_;   // m/s^2, of the slowest axis
  double begun_ = 0;      // s, of this session
  bool lost_ = true;      // nothing was valid at the start of this session
  bool settled_ = false;  // all axes were read at rest in this session
  bool may_home_;         // until the first session has settled, a homing was stopped, or the program was frozen
  int setting_tries_ = 0;
  HomingPlan homing_;
  int number_ = 0;       // of the last command
  int turn_ = 0;         // 0..5: velocity and position of each axis
  int last_listed_ = 0;  // the axis whose persistent warning was last listed
  int move_stage_ = 0;   // of a move: 0..2 speeds, 3..5 positions, then in progress
  int move_tries_ = 0;
  bool move_done_ = false;
};

}  // namespace microinjection
