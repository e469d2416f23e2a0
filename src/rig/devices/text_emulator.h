#pragma once

#include <string>
#include <vector>

#include "rig/devices/manipulator_emulator.h"

namespace microinjection {

/// What emulated devices with lines of text have in common: a command is what comes before a carriage return or a line
/// feed, an answer ends with a carriage return and takes its time. A straight motion, or none, is under way.
class TextEmulator : public ManipulatorEmulator {
 public:
  bool moves() const override { return moving_; }
  int movesBegun() const override { return moves_begun_; }

 protected:
  explicit TextEmulator(double answer_time) : answer_time_(answer_time) {}

  /// Obeys a command, which is never empty, and says what it says to it.
  virtual void handleCommand(const std::string& command, double time) = 0;
  /// Moves on to `time` (s), `dt` s since the last call; only called while it moves.
  virtual void move(double time, double dt) = 0;
  virtual std::string error(int code) const = 0;
  /// Position and settings become those after it has been switched on. It stands, and what it was told is forgotten.
  virtual void switchOn() = 0;

  void process(const std::string& bytes, double time) final;
  std::string say(double time) final;
  void checkError(const std::string& code) const final;
  void failNextCommand(const std::string& code) final;

  void answer(const std::string& line, double time) { answers_.push_back({time + answer_time_, line + "\r"}); }
  void beginMoving() { moving_ = true, ++moves_begun_; }
  void endMoving() { moving_ = false; }

 private:
  struct Answer {
    double due;  // s
    std::string bytes;
  };
  void advance(double time);

  double answer_time_;  // s
  std::string command_;
  std::vector<Answer> answers_;
  int error_ = -1;  // of the next command; -1: none
  bool moving_ = false;
  int moves_begun_ = 0;
  double time_ = 0;  // s
};

/// The words of a command, in capitals.
std::vector<std::string> capitalWords(const std::string& command);
/// @returns whether all of `text` is a whole number, which is then in `number`
bool isWhole(const std::string& text, long& number);

}  // namespace microinjection
