#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace microinjection {

/// One axis of an emulated Zaber device: its motion, its settings, its warning flags, and the commands that an axis
/// obeys. Written from the protocol's manuals and from public clients (doc/reference/devices.md), not from our driver.
///
/// The axis counts from where it was switched on until it is homed or `set pos` gives it a reference position; without
/// one it warns WR and refuses moves to a place.
class ZaberEmulatedAxis {
 public:
  struct Config {
    double travel = 0;         ///< microsteps, from the home position
    double start = 0;          ///< microsteps from the home position
    double acceleration = 0;   ///< microsteps/s^2, up and down
    double speed = 0;          ///< microsteps/s, its setting maxspeed
    bool referenced = true;    ///< since before it was switched on
    bool move_speeds = false;  ///< a move may have a speed and an acceleration of its own (firmware 7.25 and later)
  };

  explicit ZaberEmulatedAxis(const Config& config);

  double place() const { return place_; }  ///< microsteps from the home position, as it is
  bool busy() const { return velocity_ != 0 || to_place_ || target_velocity_ != 0; }
  int movesBegun() const { return moves_begun_; }
  std::vector<std::string> flags() const;  ///< that are up, the most important first

  void advance(double time);  ///< s from now
  /// Obeys a command, cut into words. Returns "OK <data>" or "RJ <reason>".
  std::string perform(const std::vector<std::string>& words);

  void setMoveSpeeds(bool has) { config_.move_speeds = has; }
  void shift(double way);  ///< microsteps, by its knob and at rest
  void interrupt();        ///< stops, as its knob does
  /// A flag that stays until `warnings clear`; a fault (F.) stops the axis at once. WR: it has lost its reference.
  void raise(const std::string& flag);
  void restart();  ///< it was switched off and on: it stands, and has no reference position

 private:
  std::string get(const std::string& name) const;
  std::string set(const std::string& name, const std::string& data);
  std::string warnings(bool clear);
  std::string stop(bool at_once);
  std::string home();
  std::string move(const std::string& how, const std::vector<std::string>& data);
  void step(double dt);
  double count() const { return place_ - zero_; }  ///< microsteps, as it tells
  double largestSpeedData() const { return resolution_ * 16384.0; }

  Config config_;
  double place_;     // microsteps from the home position
  double zero_ = 0;  // microsteps, the place that it calls 0
  bool referenced_ = true;
  std::set<std::string> raised_;
  double velocity_ = 0;         // microsteps/s
  bool to_place_ = false;       // moves to target_, otherwise at target_velocity_
  double target_ = 0;           // microsteps, a place
  double target_velocity_ = 0;  // microsteps/s
  bool homing_ = false;
  double move_speed_ = 0;                            // microsteps/s, of the move under way
  double move_acceleration_ = 0, move_braking_ = 0;  // microsteps/s^2, of the move under way
  // Settings, in the units of their data.
  long long max_speed_, acceleration_, deceleration_;
  int resolution_ = 64;
  int moves_begun_ = 0;
};

/// The most important flag of several lists, or "--".
std::string zaberFlagShown(const std::vector<std::string>& flags);
/// In order of importance, each once.
std::vector<std::string> sortedZaberFlags(std::vector<std::string> flags);
/// The data of the answer to `warnings`: how many, two digits, and which.
std::string listOfZaberFlags(const std::vector<std::string>& flags);

}  // namespace microinjection
