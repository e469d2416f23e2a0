#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "hardware/devices/move_by_move.h"
#include "hardware/serial/line_splitter.h"

namespace microinjection {

/// Keys of every device of this kind.
struct PolledManipulatorConfig : MoveByMoveConfig {
  double reading_margin = 5e-6;  ///< m, tolerance of a reading while moving, in addition to 0.1 s of motion

 protected:
  void readCommon(ConfigReader& reader, int default_baud, const Range& speeds);  ///< m/s
};

/// A manipulator with a text protocol that executes one move after another and reports its position while moving. A
/// move is never sent while another may be in progress: after any failure the device is stopped and at rest before
/// the next move. A derived class implements the dialect.
///
///     set-up lines --> stop --> position, until settled --+--> setting, read back --> move --> position, until at the
///                                                         |                                    goal and at rest
///                                                         '--> position each rest_reading_interval
///
/// These protocols have no checksum, so a line that changes bytes can send the needle to another place, or there at
/// another speed, and the device acknowledges it. A setting can be read back before it matters and is; a target
/// cannot, because the move begins with it. What remains is to watch the device on its way, at each reading, and to
/// bound how far it can get (doc/design/rigs.md, damaged_commands_test.cpp):
///
///     begin o-----o-----o - - - - - - - - - - o goal
///           |     :     '--- further than the commanded speed allows: stop, then on; twice in a row: a fault
///           |     '--------- as expected: the position is extrapolated from here
///           |      x  x----- two readings beside the line: stop and fault; another try might be changed as well
///
/// How far beside the line a reading may be grows with the speed (line_margin_), because a position may be wrong by
/// 0.1 s of motion.
///
/// A position is accepted if it is possible (at rest: unchanged), or if four successive readings agree, so that a
/// damaged reply moves nothing. A new position at rest, on an intact line, means a manual displacement if the device
/// allows it. Then the settings are sent again, since the device may have been switched off and on before.
class PolledManipulator : public MoveByMove {
 public:
  struct Dialect {
    std::string device;            ///< name, e.g. "Eppendorf PatchMan NP 2"
    std::string short_name;        ///< name in messages
    std::string guarded_stop;      ///< bytes that stop it, also after an incomplete command
    std::string farewell;          ///< bytes after the stop that return control to the operator when the program ends
    std::string stop;              ///< a line, acknowledged when the device stops
    std::string position, motion;  ///< request lines; without `motion` the position shows when it rests
    std::size_t longest_move;      ///< bytes for a move, including replies
    std::size_t longest_reading;   ///< bytes of a position request and its reply
    double stop_duration;          ///< s, to come to rest
    bool moved_by_hand;            ///< the operator may move it while this program controls it
    int move_replies = 2;          ///< exchanges for a move, with its setting
  };
  struct Plan {
    std::string setting;   ///< a line sent and read back before, unless it is set already; empty: none
    std::string move;      ///< the line of the move; both are acknowledged
    double duration = 0;   ///< s, of the move
    double speed = 0;      ///< m/s, along the path; exceeds the requested one if the device cannot move that slowly
    double deviation = 0;  ///< counts, from the straight line
  };

  ManipulatorAbilities abilities() const override;

 protected:
  PolledManipulator(const PolledManipulatorConfig& config, std::unique_ptr<Wire> wire, const Dialect& dialect);

  /// The line to send at the start of a session, in order from 0; empty: no more. Each is repeated
  /// until two replies agree, since the effect of a damaged reply would last.
  virtual std::string setup(int step) const = 0;
  /// Handles the reply to setup(step). Returns the reason why the device must not be used, or an
  /// empty text.
  virtual std::string handleSetup(int step, const std::string& reply) = 0;
  /// Counts of the device's axes; empty for a malformed line.
  virtual std::optional<Eigen::Vector3d> readPosition(const std::string& reply) = 0;
  /// Whether setup(step) sets what would stay wrong if the line has changed it: then it is read back.
  virtual bool isReadBack(int /*step*/) const { return false; }
  /// A request that shows whether `setting` is set: after it was sent, and after a failure.
  virtual std::string settingQuery(const std::string& setting) const = 0;
  virtual bool isKept(const std::string& setting, const std::string& reply) const = 0;
  virtual std::optional<bool> readMotion(const std::string& /*reply*/) const { return std::nullopt; }
  virtual bool acknowledges(const std::string& line, const std::string& reply) const = 0;
  /// Plans a straight move between positions (whole counts) at `speed` (m/s), with no axis faster
  /// than `fastest` (m/s) if the device can do that.
  virtual Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                    const Eigen::Vector3d& fastest) const = 0;
  virtual double count() const = 0;                            ///< m
  virtual std::string notArrivedReason() const { return ""; }  ///< as reported by the device

  Eigen::Vector3d counts() const final { return Eigen::Vector3d::Constant(count()); }
  double recoveryTime() const final;
  void begin(bool lost) final;
  void onStopSent() final;
  void exchange(const std::string& bytes) final;

 private:
  enum class Kind { kSettingCheck, kSetup, kStop, kPosition, kMotion, kSetting, kReadBack, kMove };
  struct Exchange {
    Kind kind;
    std::string line;
    double due;   // s of activeTime()
    double sent;  // s of activeTime(), when its last byte was sent
  };
  /// The move in progress.
  struct Progress {
    std::string setting, move;            // lines that are still to be sent; of `setting`: to be read back
    bool setting_sent = false;            // and acknowledged
    int unset_replies = 0;                // successive replies without `setting`
    int setting_tries = 0;                // in which it was not set
    Eigen::Vector3d from{0, 0, 0};        // counts, where the move began
    double sent = 0;                      // s, when its line was sent
    double speed = 0;                     // m/s, along the move, as commanded
    double end = 0;                       // s, end of the move
    double overdue = 0;                   // s of activeTime(), latest arrival
    double next = 0;                      // s, earliest start of the next move, for a speed below the device's
    int at_goal = 0;                      // successive readings
    bool zero_checked = false;            // settings were checked because it reads 0 at its goal
    std::optional<double> at_rest_since;  // s of activeTime(), since the device reports rest
  };

  double extrapolationTime() const;  // s, between two readings of a move, at the most
  static constexpr int kMostOverdue = 3;
  static constexpr char kNotArrived[] = "the move does not arrive: ";

  void handle(const std::string& reply);
  void handleSetupReply(const std::string& reply);
  void handleLostSetting();
  void handleReadBack(const std::string& reply);
  void handleUnset(const std::string& setting, const std::string& reply, int tries);
  void handleMotion(const std::string& reply);
  void handlePosition(const std::string& reply);
  void updatePosition(const Eigen::Vector3d& position);
  void contradicted(const Eigen::Vector3d& position);
  bool faultAstray(const Eigen::Vector3d& position);
  Eigen::Vector3d pointOnPath(const Eigen::Vector3d& from, double share) const;
  void checkMove(const Eigen::Vector3d& position);
  bool isTooFar(const Eigen::Vector3d& position) const;
  void handleTooFast();
  void handleMissedGoal(const Eigen::Vector3d& position);
  void handleMalformedReply(const std::string& reply);
  void forgetSettings();
  void request(Kind kind, const std::string& line);
  void next();
  void sendMove();
  void sendSetting();
  void nextOfMove();
  void nextTowardsGoal();

  /// s of motion by which an extrapolated position may be wrong, and by which axes of unequal speed may be beside
  /// their line.
  static constexpr double kExtrapolatedMotion = 0.1;
  static constexpr double kStraight = 1e-6;  // m, by which a slow device may be beside its line, besides 2 counts
  static constexpr double kFaster = 1.1;     // of the commanded speed; a device that has come further was told another

  const double reading_margin_;  // m
  double line_margin_ = 0;       // m, by which a reading of the last move may be beside its line
  const Dialect dialect_;
  LineSplitter lines_;
  std::optional<Exchange> exchange_;
  int setup_step_ = 0;
  std::optional<std::string> setup_reply_;  // the last reply to this step
  int setup_tries_ = 0;
  bool setup_sent_ = false;       // this step's line was accepted, and is read back
  int setup_unset_ = 0;           // times that it was not set
  std::string setting_;           // of the last move with one, as read back; empty: unknown
  std::string confirmed_;         // last confirmed setting; survives a failed session
  int lost_setting_replies_ = 0;  // successive replies without the setting
  bool check_setting_ = false, stop_requested_ = false, motion_requested_ = false;
  double next_move_ = 0;  // s
  int overdue_ = 0;       // readings under way, since a move has arrived
  int too_fast_ = 0;      // moves in a row that were too fast
  Progress progress_;
};

}  // namespace microinjection
