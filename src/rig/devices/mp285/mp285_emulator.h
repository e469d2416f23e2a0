#pragma once

#include <string>
#include <vector>

#include "rig/devices/manipulator_emulator.h"

namespace microinjection {

struct Mp285EmulatorConfig {
  int step_div = 25, step_mul = 4;  ///< as its status tells: (25, 4) of an MP-285, (400, 400) of an MP-285A
  Eigen::Vector3d microsteps = Eigen::Vector3d::Constant(0.04e-6);  ///< m, what a microstep of each axis truly is
  double travel = 12.5e-3;                                          ///< m, to either side of 0
  int speed = 200;                                                  ///< um/s, at the start
  bool fine = false;                                                ///< resolution at the start
  double answer_time = 2e-3;                                        ///< s, from a command's end to its answer's begin
  double command_pause = 2e-3;      ///< s after an answer in which a command's byte is not heard, but a stop is
  double baud = 9600;               ///< bit/s, of the line: says when an answer has gone
  double half_command_time = 0.25;  ///< s of silence after which half a command is forgotten
  bool locks_up = false;            ///< half a command is not forgotten, only a stop sets it free
  bool ascii_errors = true;         ///< errors as '0' to '?' (Micro-Manager), else as bare bits (acq4)
};

/// A Sutter MP-285, written from what its clients say and show, and not from the driver: the commands and the status'
/// layout from acq4 and instrulink, the status' bytes as printed from a real one, the answer to a line feed and ASCII
/// errors from Micro-Manager's adapter. While it moves it hears nothing but the stop. Errors that can be asked for: 0
/// to 15, the sum of 1, 2, 4 and 8; one with 8 is that of the next move, half way, others of the next command, which is
/// then not obeyed. Nobody has compared it with a device; what is assumed: that it is deaf in the pause after an answer
/// (clients only wait), how long half a command is remembered, that its um/s are of 25 microsteps, that it counts from
/// 0 where it is switched on.
class Mp285Emulator : public ManipulatorEmulator {
 public:
  explicit Mp285Emulator(const Mp285EmulatorConfig& config = {}) : config_(config) { switchOn(); }

  Eigen::Vector3d position() const override { return place_.cwiseProduct(config_.microsteps); }
  int movesBegun() const override { return moves_begun_; }
  bool moves() const override { return moving_; }
  void shiftByHand(const Eigen::Vector3d& way) override {
    place_ = (place_ + way.cwiseQuotient(config_.microsteps)).array().round();
  }

 protected:
  void process(const std::string& bytes, double time) override;
  std::string say(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override;
  void interrupt(double time) override;

 private:
  struct Answer {
    double due;  // s
    std::string bytes;
  };

  void switchOn();
  void advance(double time);
  void receiveByte(unsigned char byte, double time);
  void stop(double time);
  void handleCommand(double time);
  void beginMove();
  void answer(const std::string& bytes, double time) { answers_.push_back({time + config_.answer_time, bytes}); }
  void answerError(int code, double time);
  std::string status() const;

  Mp285EmulatorConfig config_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // microsteps
  int speed_ = 0;                                                                    // um/s
  bool fine_ = false, moving_ = false, absolute_ = true;
  double fails_at_ = -1;  // microsteps left of the move where it is interrupted; -1: nowhere
  int fails_with_ = 8;    // error then
  int error_ = -1;        // of the next command; -1: none
  std::vector<unsigned char> command_;
  double last_byte_ = 0;    // s
  double deaf_until_ = -1;  // s
  std::vector<Answer> answers_;
  double time_ = 0;  // s
  int moves_begun_ = 0;
};

}  // namespace microinjection
