#pragma once

#include <string>
#include <vector>

#include "rigs/manipulator_emulator.h"

namespace microinjection {

struct Mp285EmulatorConfig {
  int step_div = 25;                ///< microsteps a micrometre
  double travel = 12.5e-3;          ///< m, to either side of 0
  int speed = 1000;                 ///< um/s, at the start
  bool fine = false;                ///< resolution at the start
  double answer_time = 2e-3;        ///< s, from a command's end to its answer's begin
  double half_command_time = 0.25;  ///< s of silence after which half a command is forgotten
  bool locks_up = false;            ///< half a command is not forgotten, only a stop sets it free
  bool ascii_errors = false;        ///< errors as '0' to '8', otherwise as values
};

/// A Sutter MP-285, written from the description of its protocol and not from the driver. While it moves it hears
/// nothing but the stop. Errors that can be asked for: 0, 1, 2, 4 (of the next command, which is then not obeyed) and 8
/// (of the next move, half way).
class Mp285Emulator : public ManipulatorEmulator {
 public:
  explicit Mp285Emulator(const Mp285EmulatorConfig& config = {}) : config_(config) {
    speed_ = config.speed;
    fine_ = config.fine;
  }

  Eigen::Vector3d position() const override { return place_ * (1e-6 / config_.step_div); }
  int movesBegun() const override { return moves_begun_; }
  bool moves() const override { return moving_; }
  void shiftByHand(const Eigen::Vector3d& way) override {
    place_ = (place_ + way * (1e6 * config_.step_div)).array().round();
  }

 protected:
  void hear(const std::string& bytes, double time) override;
  std::string say(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override { error_ = code[0] - '0'; }
  void interrupt(double time) override;

 private:
  struct Answer {
    double due;  // s
    std::string bytes;
  };

  void advance(double time);
  void hearByte(unsigned char byte, double time);
  void stop(double time);
  void obey(double time);
  void beginMove();
  void answer(const std::string& bytes, double time) { answers_.push_back({time + config_.answer_time, bytes}); }
  void answerError(int code, double time);
  std::string status() const;

  Mp285EmulatorConfig config_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // microsteps
  int speed_ = 0;                                                                    // um/s
  bool fine_ = false, moving_ = false, absolute_ = true;
  double fails_at_ = -1;  // microsteps left of the move where it is interrupted; -1: nowhere
  int error_ = -1;        // of the next command; -1: none
  std::vector<unsigned char> command_;
  double last_byte_ = 0;  // s
  std::vector<Answer> answers_;
  double time_ = 0;  // s
  int moves_begun_ = 0;
};

}  // namespace microinjection
