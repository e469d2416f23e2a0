#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "hardware/devices/port_probe.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// Common part of all drivers on a line: connection, stop, failed exchanges, faults. A derived class implements the
/// device's protocol.
///
///     open --> who is there? --> stop --> silence --> begin(): read all positions --> confirmPositions(): kReady
///              (PortProbe)        ^                                                          |
///                                 +-- exchangeFailed(), stopUnheard() <----------------------+
///                                 +-- stop(), stopFirst(): nothing is lost <-----------------+
///                                 '-- guard frozen or lost: the goal is dropped <------------'
///
///     3 failures in a row: kFault, in which the same goes on without motion, until clearFault()
///
/// Whatever went wrong, the driver comes back in the same way, by a new session. To repeat the failed request would
/// be quicker. But a late reply to it is then taken for the answer to the next one, and so on for ever, while a
/// device that has lost a byte of a command may move to a place that nobody meant. A session therefore starts with a
/// stop, discards bytes until the line has been silent, and reads all positions; only when they are valid may the
/// device move. A few failures in a row become a fault instead of one more try, because a line that fails so often
/// needs a person.
///
/// - On a new line a driver whose stop another device could misunderstand asks first who is there (PortProbe).
/// - A device without a valid position for longer than a failed exchange takes counts as disconnected, and rests
///   until the next command.
/// - Commands that arrive while the device is not kReady are dropped; a completed command is not repeated, so that
///   the driver does not work against an operator who turns the device's own knob.
/// - If the program was frozen and its stop guard stopped the device, or if the guard was lost, a new session begins
///   and the device rests until the next command. Without a guard nothing moves.
/// - Time that the program did not run does not count as time in which a reply was due (activeTime()): a machine that
///   stalls is no fault of the device.
class SerialManipulator : public ManipulatorDevice {
 public:
  void limitSpeed(const Eigen::Vector3d& axes) final { speed_limits_ = axes; }
  void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) final;
  void moveTo(const Eigen::Vector3d& joints, double speed) final;
  void stop() final;
  void clearFault() final;
  void step(double time) final;
  State state() const final;
  std::string reason() const final;

 protected:
  struct Link {
    std::string device;           ///< name in messages
    std::string stop;             ///< bytes that stop the device in any state
    double quiet_in_step = 0;     ///< s of silence after which no reply to a stop is pending
    double quiet_after_loss = 0;  ///< s of silence after which neither late replies nor an incomplete command remain
    std::string farewell{};       ///< bytes after the last stop, to return control to the operator
    std::string notice{};         ///< how lines begin that the device sends by itself at any time; empty: it sends none
  };
  struct Goal {
    bool follows = false;                                ///< a set-point, otherwise a move
    Eigen::Vector3d joints = Eigen::Vector3d::Zero();    ///< m
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of a set-point
    double speed = 0;                                    ///< m/s, of a move
    double time = 0;                                     ///< s, of the command
  };

  SerialManipulator(std::unique_ptr<Wire> wire, const Link& link);
  ~SerialManipulator() override;  ///< sends a stop and the farewell

  /// To be called in the constructor of a driver whose bytes could move another device: nothing but this question is
  /// sent on a new line until it is answered.
  void askFirst(const PortProbe::Question& question);
  /// Called after the line was opened. There may be another device now.
  virtual void connected() {}
  /// Starts a session: pending requests are void, and a stop was sent. `lost`: after a failure or
  /// on a new line, so nothing is valid; otherwise the device was only stopped.
  virtual void begin(bool lost) = 0;
  /// Called after a stop was sent. The device's replies are discarded until `begin`.
  virtual void onStopSent() {}
  virtual void onStopCommand() {}  ///< called by every stop()
  /// Called after the program or its stop guard was frozen: motions without a goal must end, too.
  virtual void guardIntervened() {}
  /// Handles received bytes and sends requests.
  virtual void exchange(const std::string& bytes) = 0;
  /// Called for a new goal (goal() is set) and after the goal was removed. A repeated goal is no new one.
  virtual void goalChanged() = 0;

  double time() const { return time_; }  ///< s, of this step
  const std::optional<Goal>& goal() const { return goal_; }
  const Eigen::Vector3d& speedLimits() const { return speed_limits_; }  ///< m/s, of the joints
  bool exchanging() const { return exchanging_; }
  /// Whether positions are valid: after the first session has settled, and after a fault when a new
  /// session has.
  bool positionsValid() const { return positions_valid_ && state() != State::kDisconnected; }
  bool mayMove() const { return ready_ && fault_.empty(); }
  bool clearing() const { return clearing_; }  ///< this session tries to clear the fault
  void send(const std::string& bytes) { wire_->write(bytes, time_); }
  void dropGoal();
  void movesByItself() { stopped_ = false; }  ///< registers a motion without a goal, so that a stop is sent

  double activeTime() const { return active_time_; }  ///< s, of a clock that pauses while step() is not called
  /// The last valid position may be extrapolated for `duration` (s). maxValidityTime() can only
  /// shorten that. Afterwards the device counts as disconnected: no position, no goal, a stop,
  /// until confirmPositions().
  void validityTime(double duration) { valid_until_ = active_time_ + duration; }
  void maxValidityTime(double duration) { valid_until_ = std::min(valid_until_, active_time_ + duration); }
  /// Sets the silence (s) of Link from the next session on, for a line that is slower than
  /// expected.
  void waitForSilence(double in_step, double after_loss) {
    link_.quiet_in_step = in_step;
    link_.quiet_after_loss = after_loss;
  }
  void confirmPositions();                         ///< all positions are valid, and all axes at rest
  void exchangeSucceeded();                        ///< an exchange has succeeded
  void stopFirst();                                ///< starts a new session and continues to the goal
  void stopUnheard();                              ///< the same, for a device of which nothing is known any more
  void exchangeFailed(const std::string& reason);  ///< an exchange has failed: stops and starts a new session
  void raiseFault(const std::string& reason);      ///< stops; nothing moves until clearFault()

 private:
  void beginSession(double quiet);
  void beginLine();
  void probe(const std::string& bytes);
  std::string withOther(const std::string& reason) const;
  void connectionLost();
  bool guarded();
  void disconnect();
  bool isNoise(const std::string& bytes);
  void clearReachedGoal();

  std::unique_ptr<Wire> wire_;
  Link link_;
  double time_ = 0;         // s
  double active_time_ = 0;  // s
  double valid_until_ = 0;  // s of `active_time_`
  double next_open_ = -1;   // s
  double next_stop_ = 0;    // s, while there is no guard
  double last_byte_ = 0;    // s of active_time_, since the stop
  double drain_since_ = 0;  // s of active_time_
  std::string notice_;      // the beginning of a line that the device sends by itself
  double quiet_ = 0;        // s, of silence to wait for
  bool was_open_ = false, exchanging_ = false, ready_ = false, clearing_ = false, stop_wanted_ = false;
  bool positions_valid_ = false;
  PortProbe probe_;
  bool known_ = true;     // what is at this line
  bool served_ = false;   // its positions were valid on this line
  std::string heard_;     // on this line, until then
  bool lost_ = true;      // nothing was valid before this session
  bool stopped_ = false;  // a stop was sent, and no motion since
  int failures_ = 0, successes_ = 0;
  Eigen::Vector3d speed_limits_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  std::string reason_;  // why the device is not ready
  std::string fault_;   // empty: none
  std::optional<Goal> goal_;
};

}  // namespace microinjection
