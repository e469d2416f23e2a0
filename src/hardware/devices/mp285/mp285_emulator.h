#pragma once

#include <string>
#include <vector>

#include "hardware/devices/manipulator_emulator.h"

namespace microinjection {

struct Mp285EmulatorConfig {
  int step_div = 25, step_mul = 4;  ///< as in its status: (25, 4) of an MP-285, (400, 400) of an MP-285A
  Eigen::Vector3d microsteps = Eigen::Vector3d::Constant(0.04e-6);  ///< m, true microstep of each axis
  double travel = 12.5e-3;                                          ///< m, to either side of 0
  int speed = 200;                                                  ///< um/s, at the start
  bool fine = false;                                                ///< resolution at the start
  double answer_time = 2e-3;        ///< s, from the end of a command to the start of its reply
  double command_pause = 2e-3;      ///< s after a reply in which commands other than a stop are ignored
  double baud = 9600;               ///< bit/s, of the line; determines when a reply has been sent
  double half_command_time = 0.25;  ///< s of silence after which an incomplete command is discarded
  bool locks_up = false;            ///< an incomplete command blocks the device until a stop
  bool ascii_errors = true;         ///< errors as '0' to '?' (Micro-Manager), else as bare bits (acq4)
};

/// Emulates a Sutter MP-285. It is based on the device's clients, not on the driver: the commands
/// and the status' layout are from acq4 and instrulink, the status' bytes were printed from a real
/// device, the reply to a line feed and ASCII errors are from Micro-Manager's adapter. While moving
/// it accepts only a stop. Errors that can be injected: 0 to 15, the sum of 1, 2, 4 and 8. An error
/// with 8 interrupts the next move half way; others answer the next command, which is then not
/// executed. Not verified on a device. Assumed: it ignores bytes in the pause after a reply
/// (clients only wait), the time for which an incomplete command is kept, that its um/s are of 25
/// microsteps, and that it counts from 0 where it is switched on.
class Mp285Emulator : public ManipulatorEmulator {
 public:
  explicit Mp285Emulator(const Mp285EmulatorConfig& config = {}) : config_(config) { switchOn(); }

  Eigen::Vector3d position() const override { return position_.cwiseProduct(config_.microsteps); }
  int movesBegun() const override { return moves_begun_; }
  bool moves() const override { return moving_; }
  void shiftByHand(const Eigen::Vector3d& displacement) override {
    position_ = (position_ + displacement.cwiseQuotient(config_.microsteps)).array().round();
  }

 protected:
  void process(const std::string& bytes, double time) override;
  void advance(double time) override;
  std::string produce(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override;
  void interrupt(double time) override;

 private:
  void switchOn();
  void receiveByte(unsigned char byte, double time);
  void stop(double time);
  void handleCommand(double time);
  void beginMove();
  void reply(const std::string& bytes, double time) { sendAt(time + config_.answer_time, bytes); }
  void replyError(int code, double time);
  std::string status() const;

  Mp285EmulatorConfig config_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // microsteps
  int speed_ = 0;                                                                       // um/s
  bool fine_ = false, moving_ = false, absolute_ = true;
  double fails_at_ = -1;  // microsteps left of the move at which it is interrupted; -1: nowhere
  int fails_with_ = 8;    // error then
  int error_ = -1;        // for the next command; -1: none
  std::vector<unsigned char> command_;
  double last_byte_ = 0;    // s
  double deaf_until_ = -1;  // s
  double time_ = 0;         // s
  int moves_begun_ = 0;
};

}  // namespace microinjection
