#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "rig/devices/answer_times.h"
#include "rig/devices/axis_order.h"
#include "rig/devices/joint_axes.h"
#include "rig/devices/reading_filter.h"
#include "rig/devices/serial_manipulator.h"
#include "rig/serial/line_splitter.h"
#include "rig/serial/serial_port.h"

namespace microinjection {

/// Keys that every device below has in its file.
struct PolledManipulatorConfig {
  SerialPortConfig port;
  AxisOrder axes;
  JointAxes joints;
  double speed = 1e-3;               ///< m/s, largest along a move
  double segment_time = 0.05;        ///< s, that a short move towards a set-point should take
  double answer_time = 5e-3;         ///< s, that the device takes to answer
  double reply_timeout = 0.3;        ///< s, after which an answer is missed, besides the time on the wire
  double rest_reading_interval = 1;  ///< s, between readings at rest
  double reading_margin = 5e-6;      ///< m, by which a reading under way may be off, besides 0.1 s of motion

  double byteTime() const { return 10.0 / port.baud; }  ///< s

 protected:
  void readCommon(ConfigReader& reader, int default_baud, const Range& speeds);  ///< m/s
};

/// A manipulator behind lines of text that goes from one move to the next, as the MP-285 does, and that tells its
/// position while it moves. Set-points become short moves, each to the newest set-point. A move is never said while
/// another may be under way, nor on suspicion: after anything that went wrong the device is stopped and stands before
/// it is sent on. Its dialect is the deriving class' business.
///
/// A position counts when it is where it may be (at rest: where it was), or when four in a row agree. A device at rest
/// that tells another place after the line was lost, or where nobody but this program can move it, is a fault: its
/// coordinates may have begun anew.
class PolledManipulator : public SerialManipulator {
 public:
  struct Dialect {
    std::string device;            ///< its name, e.g. "Eppendorf PatchMan NP 2"
    std::string short_name;        ///< in messages
    std::string guarded_stop;      ///< bytes that stop it, whatever was half said before
    std::string stop;              ///< a line, answered when it stops
    std::string position, motion;  ///< lines that ask; no motion: the position tells when it stands
    std::size_t longest_move;      ///< bytes of what a move takes, answers included
    std::size_t longest_reading;   ///< bytes of a question for the position and its answer
    double stop_duration;          ///< s, that it takes to come to rest
    bool moved_by_hand;            ///< somebody else may move it while this program has it
  };
  struct Plan {
    std::vector<std::string> lines;  ///< each with an acknowledgement; the last one moves
    double duration;                 ///< s, that the move takes
  };

  ManipulatorAbilities abilities() const override;
  std::optional<Reading> reading() const override;
  bool moving() const override;

  double largestCorrection() const { return largest_correction_; }  ///< m, of a carried-on position by a reading
  int malformed() const { return malformed_; }                      ///< answers that were none

 protected:
  PolledManipulator(const PolledManipulatorConfig& config, std::unique_ptr<Wire> wire, const Dialect& dialect);

  /// The line to be said at a session's begin, in order from 0; empty: all is said. Each is said until it was answered
  /// twice alike: a damaged answer would last.
  virtual std::string setup(int step) const = 0;
  /// The answer to setup(step). Returns why the device must not be used; empty when it may.
  virtual std::string takeSetup(int step, const std::string& answer) = 0;
  /// Counts of the device's axes; empty when the line is none.
  virtual std::optional<Eigen::Vector3d> readPosition(const std::string& answer) = 0;
  virtual std::optional<bool> readMotion(const std::string& /*answer*/) const { return std::nullopt; }
  virtual bool acknowledges(const std::string& line, const std::string& answer) const = 0;
  /// A straight move between places (counts, whole) at `speed` (m/s), with no axis faster than `fastest` (m/s) where
  /// the device can do that.
  virtual Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                    const Eigen::Vector3d& fastest) = 0;
  virtual double count() const = 0;                         ///< m
  virtual double arrival() const { return 0.5; }            ///< counts from its goal at which an axis has arrived
  virtual double slowest() const { return 0; }              ///< m/s; slower ways are gone in steps
  virtual std::string whyNotArrived() const { return ""; }  ///< what the device tells of it
  /// Whatever was set in the device may be forgotten.
  virtual void sessionLost() {}

  void connected() final { answers_.forget(); }
  void begin(bool lost) final;
  void stopSaid() final;
  void talk(const std::string& bytes) final;
  void goalChanged() final { tries_ = 0; }

 private:
  static constexpr double kSame = 0.5;  // counts: what stands does not change by one

  enum class Kind { kSetup, kStop, kPosition, kMotion, kMove };
  struct Exchange {
    Kind kind;
    std::string line;
    double due;   // s of listened()
    double sent;  // s of listened(), when its last byte has gone
  };
  struct Move {
    Eigen::Vector3d from, to;  // counts
    double end;                // s, of all of it
    double begin, duration;    // s, of what is left since `from` was read
    double overdue;            // s, by when it has arrived
    double next;               // s, before which no further one begins: it goes slower than the device can
    bool follows;              // a short one towards a set-point
    std::vector<std::string> unsaid;
    int at_goal = 0;              // readings in a row
    std::optional<double> stood;  // s of listened(), since when the device says that it stands
  };

  void handle(const std::string& answer);
  void measure(const std::string& answer);
  void takeSetupAnswer(const std::string& answer);
  void takeMotion(const std::string& answer);
  void takePosition(const std::string& answer);
  void takePlace(const Eigen::Vector3d& place);
  void rest(const Eigen::Vector3d& place);
  static Eigen::Vector3d onTheWay(const Eigen::Vector3d& from, const Eigen::Vector3d& way, double share);
  void checkMove(const Eigen::Vector3d& place);
  bool beginsAnew(const Eigen::Vector3d& place);
  void malformed(const std::string& answer);
  void ask(Kind kind, const std::string& line);
  void next();
  void nextOfMove();
  void nextTowardsGoal();
  Eigen::Vector3d goalPlace() const;
  bool isThere(const Eigen::Vector3d& place, const Eigen::Vector3d& goal) const;
  double wantedSpeed(const Eigen::Vector3d& way) const;
  Eigen::Vector3d carriedOn(double time) const;
  double recoveryTime() const;
  double timeLeft() const { return move_ ? move_->begin + move_->duration - time() : 0; }

  const PolledManipulatorConfig common_;
  const Dialect dialect_;
  LineSplitter lines_;
  ReadingFilter filter_;
  AnswerTimes answers_;
  double answer_time_;  // s, as it is measured, not less than in the file
  std::optional<Exchange> exchange_;
  int setup_step_ = 0;
  std::optional<std::string> setup_answer_;  // the last one to this step
  int setup_tries_ = 0;
  bool asked_stop_ = false, settled_ = false, asked_motion_ = false;
  bool lost_session_ = false, begun_anew_ = false;
  double next_rest_reading_ = 0, next_move_ = 0;  // s
  std::optional<Eigen::Vector3d> position_;       // counts, the last true one or where it was stopped
  std::optional<Eigen::Vector3d> rested_;         // counts, where it stood when it was last heard of
  std::optional<Move> move_;                      // under way
  int tries_ = 0;                                 // moves that ended elsewhere
  double largest_correction_ = 0;                 // m
  int malformed_ = 0;
};

}  // namespace microinjection
