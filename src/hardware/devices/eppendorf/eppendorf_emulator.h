#pragma once

#include <string>
#include <vector>

#include "hardware/devices/text_emulator.h"

namespace microinjection {

struct EppendorfEmulatorConfig {
  double microstep = 0.04e-6;   ///< m; assumed, since the manual's public pages omit it
  double travel = 10e-3;        ///< m, from 0 to each limit switch
  double answer_time = 3e-3;    ///< s, from the end of a command to the start of its reply; assumed
  bool decimals = false;        ///< reports positions with two decimals
  bool manual_stops = true;     ///< C005 stops all motion, as in the manual; otherwise motion continues
  bool signs_separate = false;  ///< reports "A010 100-200+300 0", as the manual's examples of commands
};

/// Emulates an Eppendorf PatchMan NP 2, or a TransferMan NK 2. It is based on the manual's command
/// list and on AutoInj_GUI, a public program that drives an NK 2, not on the driver: C001, C003,
/// C004, C005, C007, C008, C010, C012 and C013 of the manual; C006 and C009 of the program, which
/// are C007 and C010 in microsteps; its commands begin with a small letter, too. Assumed: errors are
/// "ERR=nnn" as in a FemtoJet's manual; a go-to while moving is such an error; an axis rests at its
/// limit switch and sets bit 2i (low) or 2i + 1 (high) of axis i. An injected error answers the next
/// command, which is not executed.
class EppendorfEmulator : public TextEmulator {
 public:
  explicit EppendorfEmulator(const EppendorfEmulatorConfig& config = {})
      : TextEmulator(config.answer_time), config_(config) {}

  Eigen::Vector3d position() const override { return position_ * config_.microstep; }
  void shiftByHand(const Eigen::Vector3d& displacement) override;
  bool isRemote() const { return remote_; }

 protected:
  void handleCommand(const std::string& command, double time) override;
  void move(double time, double dt) override;
  std::string error(int code) const override;
  void interrupt(double time) override;
  void switchOn() override;

 private:
  void goTo(const std::vector<long>& numbers, double unit, const std::string& reply_at_end);
  void comeToRest(double time);
  void stop();
  int limits() const;
  std::string positionText(bool in_microsteps) const;

  EppendorfEmulatorConfig config_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // microsteps
  Eigen::Vector3d speeds_ = Eigen::Vector3d::Zero();                                    // microsteps/s
  bool remote_ = false;
  std::string at_end_;  // reply at rest; empty: none
};

/// A TransferMan NK 2, whose microsteps AutoInj_GUI tells: 25.6 a micrometre.
struct TransfermanEmulatorConfig : EppendorfEmulatorConfig {
  TransfermanEmulatorConfig() { microstep = 1 / 25.6e6; }
};
class TransfermanEmulator : public EppendorfEmulator {
 public:
  explicit TransfermanEmulator(const TransfermanEmulatorConfig& config = {}) : EppendorfEmulator(config) {}
};

}  // namespace microinjection
