#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rig/devices/move_by_move.h"
#include "rig/devices/mp285/mp285_config.h"
#include "rig/devices/mp285/mp285_protocol.h"

namespace microinjection {

/// Sutter MP-285. After each move the position is read; while it moves it says nothing, and the position is carried on
/// with the set speed.
///
/// A move is never sent on suspicion: after anything that went wrong the position is read first, and what is left of
/// the way, if anything, is a move of its own. Another place at rest is that of its hand wheel; what is set in it is
/// then said again: it may have been switched off and on before.
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
    double due;   // s of listened(), to be answered
    double sent;  // s of listened(), when its last byte has gone
  };
  struct Speed {
    int um_per_s = 0;
    bool fine = true;
    bool operator==(const Speed& other) const { return um_per_s == other.um_per_s && fine == other.fine; }
  };

  void ask(Kind kind, const std::string& bytes, double more_time = 0);
  void handle(const Mp285Answer& answer);
  void handleError(int error);
  void takeStatus(const Mp285Status& status);
  void takePosition(const Mp285Position& position);
  void forgetSettings();
  void next();
  void nextTowardsGoal();
  double metresPerSaidMetre(const Eigen::Vector3d& way) const;
  Speed speedFor(const Eigen::Vector3d& way) const;

  const Mp285Config config_;
  Mp285Parser parser_;
  std::optional<Exchange> exchange_;
  double last_byte_ = 0;     // s of listened()
  double next_command_ = 0;  // s of listened(), at the earliest
  /// m, a microstep of the device's axes as they are, and as the device's own um/s count them.
  Eigen::Vector3d microsteps_ = Eigen::Vector3d::Constant(0.04e-6);
  double nominal_microstep_ = 0.04e-6;
  std::optional<Mp285Status> told_status_;  // the last one
  bool stop_requested_ = false, status_requested_ = false, absolute_ = false;
  bool reading_due_ = true;         // the position is to be read
  bool coarse_ = false;             // the move under way
  std::optional<Speed> speed_;      // that the device was told
  std::optional<Speed> confirmed_;  // that the device has confirmed, not forgotten with a lost session
};

}  // namespace microinjection
