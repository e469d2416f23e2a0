#pragma once

#include <string>

#include "hardware/devices/manipulator_emulator.h"

namespace microinjection {

/// Common part of emulated devices with text lines. A command ends with a carriage return or a line
/// feed. A reply ends with a carriage return and is delayed. At most one straight motion is in
/// progress.
class TextEmulator : public ManipulatorEmulator {
 public:
  bool moves() const override { return moving_; }
  int movesBegun() const override { return moves_begun_; }

 protected:
  explicit TextEmulator(double answer_time) : answer_time_(answer_time) {}

  /// Executes a command, which is never empty, and replies.
  virtual void handleCommand(const std::string& command, double time) = 0;
  /// Advances the motion to `time` (s), `dt` s after the last call. Only called while moving.
  virtual void move(double time, double dt) = 0;
  virtual std::string error(int code) const = 0;
  /// Resets position and settings to those after switching on. The device is at rest with no
  /// commands.
  virtual void switchOn() = 0;

  void process(const std::string& bytes, double time) final;
  void advance(double time) final;
  void checkError(const std::string& code) const final;
  void failNextCommand(const std::string& code) final;

  void reply(const std::string& line, double time) { sendAt(time + answer_time_, line + "\r"); }
  void beginMoving() { moving_ = true, ++moves_begun_; }
  void endMoving() { moving_ = false; }

 private:
  double answer_time_;  // s
  std::string command_;
  int error_ = -1;  // for the next command; -1: none
  bool moving_ = false;
  int moves_begun_ = 0;
  double time_ = 0;  // s
};

}  // namespace microinjection
