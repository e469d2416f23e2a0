#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "rig/manipulator/manipulator_device.h"
#include "rig/serial/wire.h"

namespace microinjection {

/// What all manipulators behind a serial line have in common: the line that may break, the stop that comes first, an
/// exchange that went wrong, faults. A device's driver adds the conversation.
///
/// A session begins, after the line has been opened and after anything went wrong, with a stop; then what comes belated
/// is thrown away until the line has been silent; then the driver asks where everything is. Only when it knows may
/// anything move. A device that tells no true position for longer than an exchange that went wrong explains counts as
/// not connected, and rests until the next command. When it fails a few times in a row, the reason becomes a fault, and
/// motion waits for clearFault(). Commands that come while the device is not kReady are not kept, and neither is one
/// that has been carried out. When the program stood still and its stop guard stopped the device, or the guard was
/// lost, the session begins anew and the device rests until the next command; while there is no guard nothing moves.
class SerialManipulator : public ManipulatorDevice {
 public:
  void limitSpeed(const Eigen::Vector3d& axes) final { speed_limits_ = axes; }
  void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) final;
  void moveTo(const Eigen::Vector3d& joints, double speed) final;
  void stop() final;
  void clearFault() final;
  void step(double time) final;
  State state() const final;
  std::string why() const final;

 protected:
  struct Link {
    std::string device;           ///< its name in messages
    std::string stop;             ///< bytes that stop it, whatever it is doing
    double quiet_in_step = 0;     ///< s of silence that end what follows a stop
    double quiet_after_loss = 0;  ///< s of silence after which nothing belated comes and no half command is left
    std::string farewell{};       ///< bytes after the last stop, which give the device back
  };
  struct Goal {
    bool follows = false;                                ///< a set-point, otherwise a move
    Eigen::Vector3d joints = Eigen::Vector3d::Zero();    ///< m
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of a set-point
    double speed = 0;                                    ///< m/s, of a move
    double time = 0;                                     ///< s, when it came
  };

  SerialManipulator(std::unique_ptr<Wire> wire, const Link& link);
  ~SerialManipulator() override;  ///< sends a stop and the farewell

  /// The line has been opened: there may be another device at its end.
  virtual void connected() {}
  /// Begins the conversation anew: whatever was asked is void, and the device has been told to stop. `lost`: something
  /// went wrong or the line is new, so that nothing is known of the device; otherwise it was just stopped.
  virtual void begin(bool lost) = 0;
  /// The device has been told to stop and will stand in a moment; what it says is not heard until `begin`.
  virtual void onStopSent() {}
  virtual void stopAsked() {}  ///< by stop(), at once and each time
  /// The program or its stop guard stood still: not even what moves without a goal may go on by itself.
  virtual void guardIntervened() {}
  /// Goes on with the conversation: with what came, and with what is to be said.
  virtual void exchange(const std::string& bytes) = 0;
  /// A new goal (goal() is set) came or the goal went.
  virtual void goalChanged() = 0;

  double time() const { return time_; }  ///< s, of this step
  const std::optional<Goal>& goal() const { return goal_; }
  const Eigen::Vector3d& speedLimits() const { return speed_limits_; }  ///< m/s, of the joints
  bool exchanging() const { return exchanging_; }
  /// Whether positions may be told: not before the first session has settled, and from a fault until one has again.
  bool sure() const { return positions_valid_ && state() != State::kDisconnected; }
  bool mayMove() const { return ready_ && fault_.empty(); }
  bool clearing() const { return clearing_; }  ///< clearFault() was called and this session tries
  void say(const std::string& bytes) { wire_->write(bytes, time_); }
  void dropGoal();
  void movesByItself() { stopped_ = false; }  ///< without a goal, so that a stop has something to stop

  double listened() const { return listened_; }  ///< s, a clock that does not run while nobody steps
  /// The last true position, carried on, may be told for so long (s); maxValidityTime only shortens that. Then it is as
  /// if the line were broken: no position, no goal, a stop, until the driver says known() again.
  void validityTime(double duration) { valid_until_ = listened_ + duration; }
  void maxValidityTime(double duration) { valid_until_ = std::min(valid_until_, listened_ + duration); }
  /// From the next session on: s of silence, as in Link, on a line that turned out to be slow.
  void waitForSilence(double in_step, double after_loss) {
    link_.quiet_in_step = in_step;
    link_.quiet_after_loss = after_loss;
  }
  void known();                                ///< the driver knows where everything is, and everything is at rest
  void understood();                           ///< an exchange has succeeded
  void stopFirst();                            ///< begins anew, and goes on to the goal
  void lostStep(const std::string& reason);    ///< an exchange has failed: stops and begins anew
  void raiseFault(const std::string& reason);  ///< stops and lets nothing move until clearFault()

 private:
  void beginSession(double quiet);
  void connectionLost();
  bool guarded();
  void disconnect();
  void clearReachedGoal();

  std::unique_ptr<Wire> wire_;
  Link link_;
  double time_ = 0;         // s
  double listened_ = 0;     // s
  double valid_until_ = 0;  // s of `listened_`
  double next_open_ = -1;   // s
  double next_stop_ = 0;    // s, while there is no guard
  double last_byte_ = 0;    // s of listened_, since the stop
  double drain_since_ = 0;  // s of listened_
  double quiet_ = 0;        // s, of silence to wait for
  bool was_open_ = false, exchanging_ = false, ready_ = false, clearing_ = false, stop_wanted_ = false;
  bool positions_valid_ = false;  // where everything is
  bool lost_ = true;              // before this session
  bool stopped_ = false;          // told to stop, and to do nothing since
  int failures_ = 0, successes_ = 0;
  Eigen::Vector3d speed_limits_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  std::string why_;    // it is not ready
  std::string fault_;  // empty: none
  std::optional<Goal> goal_;
};

}  // namespace microinjection
