#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rig/devices/answer_times.h"
#include "rig/devices/mp285/mp285_config.h"
#include "rig/devices/mp285/mp285_protocol.h"
#include "rig/devices/reading_filter.h"
#include "rig/devices/serial_manipulator.h"

namespace microinjection {

/// Sutter MP-285. Set-points become short moves, each to the newest set-point; after each the position is read. While
/// it moves, the position is carried on along the straight line with the set speed, never past the move's end.
///
/// A move is never sent on suspicion: after anything that went wrong the position is read first, and what is left of
/// the way, if anything, is a move of its own.
class Mp285Driver : public SerialManipulator {
 public:
  Mp285Driver(const Mp285Config& config, std::unique_ptr<Wire> wire);

  ManipulatorAbilities abilities() const override;
  std::optional<Reading> reading() const override;
  bool moving() const override;

  double largestCorrection() const { return largest_correction_; }  ///< m, of a carried-on position by a reading
  int malformed() const { return malformed_; }                      ///< answers that were none

 protected:
  void connected() override { answers_.forget(); }
  void begin(bool lost) override;
  void stopSaid() override;
  void talk(const std::string& bytes) override;
  void goalChanged() override { tries_ = 0; }

 private:
  enum class Kind { kStop, kStatus, kAbsolute, kPosition, kVelocity, kMove };
  struct Exchange {
    Kind kind;
    double due;   // s of listened(), to be answered
    double sent;  // s of listened(), when its last byte has gone
  };
  struct Move {
    Eigen::Vector3d from, to;  // microsteps, of the device
    double begin, duration;    // s
    bool follows;              // a short one towards a set-point
    bool coarse;
  };
  struct Speed {
    int um_per_s = 0;
    bool fine = true;
    bool operator==(const Speed& other) const { return um_per_s == other.um_per_s && fine == other.fine; }
  };

  void measure(const Mp285Answer& answer);
  double byteTime() const { return 10.0 / config_.port.baud; }
  void ask(Kind kind, const std::string& bytes, double more_time = 0);
  void handle(const Mp285Answer& answer);
  void handleError(int error);
  void takeStatus(const Mp285Status& status);
  void takePosition(const Mp285Position& position);
  void next();
  void nextTowardsGoal();
  Eigen::Vector3d goalPlace() const;
  int fastestAlong(const Eigen::Vector3d& way) const;
  double metresPerSaidMetre(const Eigen::Vector3d& way) const;
  double length(const Eigen::Vector3d& way) const { return way.cwiseProduct(microsteps_).norm(); }  // m
  Speed speedFor(const Eigen::Vector3d& way) const;
  Eigen::Vector3d carriedOn(double time) const;
  double recoveryTime() const;
  double timeLeft() const;

  Mp285Config config_;
  Mp285Parser parser_;
  ReadingFilter filter_;
  AnswerTimes answers_;
  double answer_time_;  // s, as it is measured, not less than in the file
  std::optional<Exchange> exchange_;
  double last_byte_ = 0;     // s of listened()
  double next_command_ = 0;  // s of listened(), at the earliest
  /// m, a microstep of the device's axes as they are, and as the device's own um/s count them.
  Eigen::Vector3d microsteps_ = Eigen::Vector3d::Constant(0.04e-6);
  double nominal_microstep_ = 0.04e-6;
  std::optional<Mp285Status> told_status_;  // the last one
  bool asked_stop_ = false, asked_status_ = false, absolute_ = false, settled_ = false;
  bool reading_due_ = true;                  // the position is to be read
  double next_rest_reading_ = 0;             // s
  std::optional<Eigen::Vector3d> position_;  // microsteps, the last true one or where it was stopped
  std::optional<Move> move_;                 // under way, or over and not yet read
  std::optional<Speed> speed_;               // that the device is set to
  int tries_ = 0;                            // moves that ended elsewhere
  double largest_correction_ = 0;            // m
  int malformed_ = 0;
};

}  // namespace microinjection
