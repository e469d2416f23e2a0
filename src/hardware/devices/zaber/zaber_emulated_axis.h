#pragma once

#include <set>
#include <string>
#include <vector>

namespace microinjection {

/// One axis of an emulated Zaber device: motion, settings, warning flags and the commands of an
/// axis. It is based on the protocol's manuals and on public clients (doc/reference/devices.md),
/// not on our driver.
///
/// The axis counts from where it was switched on until it is homed or `set pos` gives it a
/// reference position. Without one it warns WR and refuses absolute moves.
class ZaberEmulatedAxis {
 public:
  struct Config {
    double travel = 0;         ///< microsteps, from the home position
    double start = 0;          ///< microsteps from the home position
    double acceleration = 0;   ///< microsteps/s^2, up and down
    double speed = 0;          ///< microsteps/s, its setting maxspeed
    bool referenced = true;    ///< since before it was switched on
    bool move_speeds = false;  ///< a move may have its own speed and acceleration (firmware 7.25 and later)
  };

  explicit ZaberEmulatedAxis(const Config& config);

  double position() const { return position_; }  ///< microsteps from the home position, true
  bool busy() const { return velocity_ != 0 || to_position_ || target_velocity_ != 0; }
  int movesBegun() const { return moves_begun_; }
  std::vector<std::string> flags() const;  ///< active flags, the most important first

  void advance(double time);  ///< s from now
  /// Executes a command, split into words. Returns "OK <data>" or "RJ <reason>".
  std::string perform(const std::vector<std::string>& words);

  void setMoveSpeeds(bool has) { config_.move_speeds = has; }
  void shift(double displacement);  ///< microsteps, by its knob and at rest
  void interrupt();                 ///< stops, as its knob does
  /// Sets a flag until `warnings clear`. A fault (F.) stops the axis at once. WR: it has lost its
  /// reference.
  void raise(const std::string& flag);
  void restart();  ///< switches off and on: it rests without a reference position

 private:
  std::string get(const std::string& name) const;
  std::string set(const std::string& name, const std::string& data);
  std::string warnings(bool clear);
  std::string stop(bool at_once);
  std::string home();
  std::string move(const std::string& how, const std::vector<std::string>& data);
  void step(double dt);
  double count() const { return position_ - zero_; }  ///< microsteps, as reported
  double largestSpeedData() const { return resolution_ * 16384.0; }

  Config config_;
  double position_;  // microsteps from the home position
  double zero_ = 0;  // microsteps, position of its count 0
  bool referenced_ = true;
  std::set<std::string> raised_;
  double velocity_ = 0;         // microsteps/s
  bool to_position_ = false;    // moves to target_, otherwise at target_velocity_
  double target_ = 0;           // microsteps, a position
  double target_velocity_ = 0;  // microsteps/s
  bool homing_ = false;
  double move_speed_ = 0;                            // microsteps/s, of the present move
  double move_acceleration_ = 0, move_braking_ = 0;  // microsteps/s^2, of the present move
  // Settings, in the units of their data.
  long long max_speed_, acceleration_, deceleration_;
  int resolution_ = 64;
  int moves_begun_ = 0;
};

/// The most important flag of several lists, or "--".
std::string zaberFlagShown(const std::vector<std::string>& flags);
/// In order of importance, each once.
std::vector<std::string> sortedZaberFlags(std::vector<std::string> flags);
/// The data of the reply to `warnings`: the number of flags, two digits, and the flags.
std::string listOfZaberFlags(const std::vector<std::string>& flags);

}  // namespace microinjection
