#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hardware/devices/move_by_move.h"
#include "hardware/devices/mp285/mp285_protocol.h"

namespace microinjection {

struct Mp285Config : MoveByMoveConfig {
  /// m per microstep of the device's axes X, Y, Z; 0: from its status, if that is a known one
  Eigen::Vector3d microsteps = Eigen::Vector3d::Zero();
  double move_allowance = 0.05;    ///< s, that a move may take beyond 1.25 times its way over its speed
  double command_pause = 2e-3;     ///< s, between a reply and the next command
  double half_command_time = 0.3;  ///< s of silence after which the device discards an incomplete command

  /// `rest_reading_interval` may be 0: no readings at rest.
  static Mp285Config read(ConfigReader& reader);
};

/// Driver of the Sutter MP-285. The position is read after each move. While moving the device does
/// not reply, and the position is extrapolated with the set speed. So a move is a part of the way
/// that takes a tenth of a second, after which the device is stopped unless it has replied: a
/// command whose bytes the line has changed leads no further.
///
/// After any failure the position is read before the next move; the rest of the path, if any, is a
/// move of its own. Another position at rest is due to the hand wheel. Then the settings are sent
/// again, since the device may have been switched off and on before.
class Mp285Driver : public MoveByMove {
 public:
  Mp285Driver(const Mp285Config& config, std::unique_ptr<Wire> wire);

  ManipulatorAbilities abilities() const override;

 protected:
  Eigen::Vector3d counts() const override { return microsteps_; }
  double recoveryTime() const override;
  void begin(bool lost) override;
  void exchange(const std::string& bytes) override;

 private:
  enum class Kind { kStop, kStatus, kAbsolute, kPosition, kVelocity, kMove };
  struct Exchange {
    Kind kind;
    double due;   // s of activeTime(), deadline of the reply
    double sent;  // s of activeTime(), when its last byte was sent
  };
  struct Speed {
    int um_per_s = 0;
    bool fine = true;
    bool operator==(const Speed& other) const { return um_per_s == other.um_per_s && fine == other.fine; }
  };

  void request(Kind kind, const std::string& bytes, double more_time = 0);
  void handle(const Mp285Reply& reply);
  void handleError(int error);
  void handleStatus(const Mp285Status& status);
  void handlePosition(const Mp285Position& position);
  void forgetSettings();
  void next();
  void nextTowardsGoal();
  double metresPerNominalMetre(const Eigen::Vector3d& displacement) const;
  Speed speedFor(const Eigen::Vector3d& displacement) const;

  const Mp285Config config_;
  Mp285Parser parser_;
  std::optional<Exchange> exchange_;
  double last_byte_ = 0;     // s of activeTime()
  double next_command_ = 0;  // s of activeTime(), at the earliest
  /// m per microstep: true values of the axes, and the one that the device's um/s assume.
  Eigen::Vector3d microsteps_ = Eigen::Vector3d::Constant(0.04e-6);
  double nominal_microstep_ = 0.04e-6;
  std::optional<Mp285Status> last_status_;
  bool stop_requested_ = false, status_requested_ = false, absolute_ = false;
  bool reading_due_ = true;         // the position must be read
  bool coarse_ = false;             // of the move in progress
  std::optional<Speed> speed_;      // sent to the device
  std::optional<Speed> confirmed_;  // confirmed by the device; survives a failed session
};

}  // namespace microinjection
