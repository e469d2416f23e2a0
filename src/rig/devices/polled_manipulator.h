#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "rig/devices/move_by_move.h"
#include "rig/serial/line_splitter.h"

namespace microinjection {

/// Keys that every device below has in its file.
struct PolledManipulatorConfig : MoveByMoveConfig {
  double reading_margin = 5e-6;  ///< m, by which a reading under way may be off, besides 0.1 s of motion

 protected:
  void readCommon(ConfigReader& reader, int default_baud, const Range& speeds);  ///< m/s
};

/// A manipulator behind lines of text that goes from one move to the next and tells its position while it moves. A
/// move is never said while another may be under way, nor on suspicion: after anything that went wrong the device is
/// stopped and stands before it is sent on. Its dialect is the deriving class' business.
///
/// A position counts when it is where it may be (at rest: where it was), or when four in a row agree. Another place at
/// rest, with the line sound, is that of a hand, if the device can be moved by hand. What was set in it is then said
/// again: it may have been switched off and on before.
class PolledManipulator : public MoveByMove {
 public:
  struct Dialect {
    std::string device;            ///< its name, e.g. "Eppendorf PatchMan NP 2"
    std::string short_name;        ///< in messages
    std::string guarded_stop;      ///< bytes that stop it, whatever was half said before
    std::string farewell;          ///< bytes that give it back when the program ends, after the stop
    std::string stop;              ///< a line, answered when it stops
    std::string position, motion;  ///< lines that ask; no motion: the position tells when it stands
    std::size_t longest_move;      ///< bytes of what a move takes, answers included
    std::size_t longest_reading;   ///< bytes of a question for the position and its answer
    double stop_duration;          ///< s, that it takes to come to rest
    bool moved_by_hand;            ///< somebody else may move it while this program has it
  };
  struct Plan {
    std::string setting;  ///< a line that is said before, unless it was the last one; empty: none
    std::string move;     ///< the line that moves; both have an acknowledgement
    double duration = 0;  ///< s, that the move takes
    double speed = 0;     ///< m/s, along it; may be more than was asked for, where the device cannot go that slowly
    double aside = 0;     ///< counts, by which it leaves the straight line
  };

  ManipulatorAbilities abilities() const override;

 protected:
  PolledManipulator(const PolledManipulatorConfig& config, std::unique_ptr<Wire> wire, const Dialect& dialect);

  /// The line to be said at a session's begin, in order from 0; empty: all is said. Each is said until it was answered
  /// twice alike: a damaged answer would last.
  virtual std::string setup(int step) const = 0;
  /// The answer to setup(step). Returns why the device must not be used; empty when it may.
  virtual std::string takeSetup(int step, const std::string& answer) = 0;
  /// Counts of the device's axes; empty when the line is none.
  virtual std::optional<Eigen::Vector3d> readPosition(const std::string& answer) = 0;
  /// A line that tells after a lost session whether a setting, the last one that the device has confirmed, is kept.
  virtual std::string askKept(const std::string& setting) const = 0;
  virtual bool isKept(const std::string& setting, const std::string& answer) const = 0;
  virtual std::optional<bool> readMotion(const std::string& /*answer*/) const { return std::nullopt; }
  virtual bool acknowledges(const std::string& line, const std::string& answer) const = 0;
  /// A straight move between places (counts, whole) at `speed` (m/s), with no axis faster than `fastest` (m/s) where
  /// the device can do that.
  virtual Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
                    const Eigen::Vector3d& fastest) const = 0;
  virtual double count() const = 0;                         ///< m
  virtual std::string whyNotArrived() const { return ""; }  ///< what the device tells of it

  Eigen::Vector3d counts() const final { return Eigen::Vector3d::Constant(count()); }
  double recoveryTime() const final;
  void begin(bool lost) final;
  void onStopSent() final;
  void exchange(const std::string& bytes) final;

 private:
  enum class Kind { kKept, kSetup, kStop, kPosition, kMotion, kMove };
  struct Exchange {
    Kind kind;
    std::string line;
    double due;   // s of listened()
    double sent;  // s of listened(), when its last byte has gone
  };
  /// Of the move under way.
  struct Progress {
    std::string setting, move;    // lines, as long as they are not said
    double end = 0;               // s, of all of it
    double overdue = 0;           // s of listened(), by when it has arrived
    double next = 0;              // s, before which no further one begins: it goes slower than the device can
    int at_goal = 0;              // readings in a row
    bool zero_asked = false;      // whether its settings are kept, when it reads 0 at its goal
    std::optional<double> stood;  // s of listened(), since when the device says that it stands
  };

  /// A way that may be gone in parts, and where its next part begins.
  struct Line {
    Eigen::Vector3d begin, goal, next;  // counts
  };

  void handle(const std::string& answer);
  void takeSetupAnswer(const std::string& answer);
  void takeNotKept();
  void takeMotion(const std::string& answer);
  void takePosition(const std::string& answer);
  void takePlace(const Eigen::Vector3d& place);
  Eigen::Vector3d onTheWay(const Eigen::Vector3d& from, double share) const;
  void checkMove(const Eigen::Vector3d& place);
  void endedElsewhere(const Eigen::Vector3d& place);
  void notUnderstood(const std::string& answer);
  void forgetSettings();
  void ask(Kind kind, const std::string& line);
  void next();
  void sayMove();
  void nextOfMove();
  void nextTowardsGoal();

  const double reading_margin_;  // m
  const Dialect dialect_;
  LineSplitter lines_;
  std::optional<Exchange> exchange_;
  int setup_step_ = 0;
  std::optional<std::string> setup_answer_;  // the last one to this step
  int setup_tries_ = 0;
  std::string setting_;    // of the last move that had one; empty: not known
  std::string confirmed_;  // setting, not forgotten with a lost session
  int not_kept_ = 0;       // answers in a row, that it is not kept
  bool ask_kept_ = false, stop_requested_ = false, asked_motion_ = false;
  double next_move_ = 0;  // s
  Progress progress_;
  std::optional<Line> line_;  // the last one
};

}  // namespace microinjection
