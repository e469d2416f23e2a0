#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "hardware/devices/position_filter.h"
#include "hardware/devices/reply_times.h"
#include "hardware/devices/serial_manipulator.h"
#include "hardware/devices/zaber/zaber_config.h"
#include "hardware/devices/zaber/zaber_protocol.h"
#include "hardware/devices/zaber/zaber_settings.h"

namespace microinjection {

/// Driver of three Zaber axes, of one controller or of three chained devices, in Zaber's ASCII protocol.
///
///     a turn:   velocity 1   position 1   velocity 2   position 2   velocity 3   position 3   (list of warnings)
///               if it has changed or must be renewed                                          of an axis with one
///
/// It follows set-points by a stream of velocities: the set-point's, plus the distance from it times a gain. A stream
/// of positions would be simpler; but each move ends at rest, and with a new one in each turn the motion would be
/// jerky. A velocity that goes on until the next one has a fault of its own: it goes on, too, when the line or this
/// computer fails, up to the end of travel. From firmware 7.25 on a velocity is therefore a move to where it leads in
/// `move_horizon`, renewed in every turn, so that the axes stop by themselves. Near the end of travel, and with older
/// firmware, it is a plain velocity. A set-point that rests is approached by a move to it, since control by
/// velocities alone would overshoot. Moves are the device's own, with a speed for each axis that makes the path
/// straight except for the ramps.
///
/// One message at a time is on the line, so that each reply has its request. The gain therefore, and with it the lag,
/// follows from the line's speed: a loop with a dead time T is well damped up to a gain of about 0.4 / T, and T is
/// about a turn of six exchanges. The reply time is measured at the start of a session, and turn, gain and horizon
/// are adapted to it. Acceleration and microsteps of the devices must be those of the file.
///
/// What is not believed at once:
///
/// - A reply. Commands have, unless the file says otherwise, a checksum and a number, which comes back in the reply
///   and tells a late one. Two replies to one number that differ are those of two devices with one address, which
///   would both move: a fault.
/// - A position. One off its expected place counts only when four agree (PositionFilter).
/// - A reference. An axis without one is a fault, and no position is reported. A reply shows only its most important
///   flag, behind which a lost reference may hide. So the axis is asked for all of its flags, before its position is
///   used and then in turn. Warnings that change faster than they can be listed are a fault.
///
/// Homing moves the axes, so it needs the user's consent (`home: true`, at the start only) or the maker's tool. All
/// axes home, in the plan's order, since an axis that has its reference may be in another's path.
///
/// Sources: Zaber's ASCII protocol manual, Micro-Manager's Zaber adapter. No device was connected yet
/// (doc/reference/devices.md).
class ZaberDriver : public SerialManipulator {
 public:
  /// @pre `config` is valid, as ZaberConfig::read returns it
  ZaberDriver(const ZaberConfig& config, std::unique_ptr<Wire> wire);

  ManipulatorAbilities abilities() const override;
  std::optional<Reading> reading() const override;
  bool moving() const override;
  std::optional<Eigen::Vector3d> homingEnds() const override {
    if (!config_.home) return std::nullopt;
    return config_.joints.toJoints(Eigen::Vector3d::Zero());  // an axis counts from its reference position
  }
  void planHoming(const HomingPlan& plan) override { homing_ = plan; }

  std::string note() const override;                     ///< axes with a warning, and which
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

  double gain() const;     // 1/s, see the class comment
  double horizon() const;  // s, until a velocity ends by itself
  double exchangeTime() const { return config_.exchangeTime(answer_time_); }
  double turnTime() const;              // s
  double longestAge() const;            // s, of a position that still counts
  double longestExtrapolation() const;  // s
  double fastest(int axis) const;       // m/s
  long long speedData(int axis, double speed) const;
  double expected(int axis, double time) const;   // m of the device, extrapolated; NaN: not known
  int axisOf(const ZaberAddress& address) const;  // -1: none of ours
  std::string axisName(int axis) const;
  std::string axesNote() const;

  // Replies.
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

  // Start of a session. A function that begins with `next` returns whether it has sent something.
  bool nextOfSession();
  bool nextOfAxis(int axis);
  bool nextOfHoming();
  void home(int axis);
  bool nextOfSettings();
  void handleSetting(const Exchange& request, const std::string& data);
  std::string settingsMismatch(int axis) const;
  std::string checkSettings();
  void adaptToReplyTime();

  // In turn.
  void next();
  bool nextOfWarnings();
  bool nextOfMove();
  void nextInTurn();
  void requestWarningsAgain();
  void checkMove();
  void request(Kind kind, int axis, const std::string& command, long long value = 0, double end = std::nan(""));
  void sendExchange();
  long long velocityData(int axis) const;  // units of speed
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
