#pragma once

#include <array>
#include <string>
#include <vector>

#include "rigs/manipulator_emulator.h"

namespace microinjection {

struct ZaberEmulatorConfig {
  std::array<int, 3> devices{1, 1, 1};  ///< device number of each axis; three chained devices: 1, 2, 3
  std::array<int, 3> axes{1, 2, 3};     ///< its number in its device; three chained devices: 1, 1, 1
  double microstep = 0.047625e-6;       ///< m
  double travel = 25e-3;                ///< m, from 0
  double start = 12.5e-3;               ///< m, of every axis
  double acceleration = 0.2;            ///< m/s^2
  double speed = 5e-3;                  ///< m/s, its setting maxspeed at the start
  double answer_time = 1e-3;            ///< s, from a command's end to its answer's begin
  std::string firmware = "7.25";        ///< MAJOR.MINOR, as `get version` says it
  bool referenced = true;               ///< false: axes warn WR until they have been homed, and refuse moves to a place
};

/// Zaber axes with the ASCII protocol, written from the protocol's description and not from the driver.
///
/// From firmware 7.25 on a move may have a speed and an acceleration of its own, in the data of maxspeed and accel;
/// before, such a move is refused.
///
/// Errors that can be asked for: a reason of rejection (BADDATA, AGAIN, ...) of the next command, or a warning flag of
/// two characters (FS: stalled), which stays on all axes until `warnings clear`; a fault stops them.
class ZaberEmulator : public ManipulatorEmulator {
 public:
  explicit ZaberEmulator(const ZaberEmulatorConfig& config = {});

  Eigen::Vector3d position() const override;
  int movesBegun() const override { return moves_begun_; }
  bool moves() const override;
  void shiftByHand(const Eigen::Vector3d& way) override;
  void setFirmware(const std::string& version) override;

 protected:
  void hear(const std::string& bytes, double time) override;
  std::string say(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override;
  void interrupt(double time) override;

 private:
  struct Axis {
    int device, number;
    double place;           // microsteps
    double velocity = 0;    // microsteps/s
    bool to_place = false;  // moves to `target`, otherwise at `target_velocity`
    double target = 0;      // microsteps
    double target_velocity = 0;
    double max_speed = 0;     // microsteps/s, its setting
    double move_speed = 0;    // microsteps/s, of the move under way
    double acceleration = 0;  // microsteps/s^2, of the move under way
    bool homing = false, referenced = true;
    std::string flag;  // empty: none
    bool busy() const { return velocity != 0 || to_place || target_velocity != 0; }
  };
  struct Answer {
    double due;  // s
    std::string text;
  };

  void advance(double time);
  void advanceAxis(Axis& axis, double dt) const;
  void obey(const std::string& line);
  void tellVersion(int device, const std::string& id, bool checksum);
  std::string perform(Axis& axis, const std::string& command);
  std::string beginMove(Axis& axis, const std::string& how, const std::string& data);
  void answer(const Axis& axis, const std::string& number, const std::string& verdict_and_data, bool checksum);

  ZaberEmulatorConfig config_;
  std::array<Axis, 3> axes_;
  std::vector<Answer> answers_;
  std::string line_;
  std::string rejection_;  // of the next command; empty: none
  double time_ = 0;        // s
  int moves_begun_ = 0;
  bool moves_have_speeds_ = true;  // of their own
};

}  // namespace microinjection
