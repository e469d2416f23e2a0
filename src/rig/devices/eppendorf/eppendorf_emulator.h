#pragma once

#include <array>
#include <string>

#include "rig/devices/text_emulator.h"

namespace microinjection {

struct EppendorfEmulatorConfig {
  double microstep = 0.04e-6;   ///< m; assumed, the manual's public pages do not tell it
  double travel = 10e-3;        ///< m, to either side of 0, where the limit switches are
  double answer_time = 3e-3;    ///< s, from a command's end to its answer's begin; assumed
  bool decimals = false;        ///< tells positions with two decimals
  bool manual_stops = true;     ///< C005 stops what moves, as the manual says; else what moves goes on
  bool signs_separate = false;  ///< tells a position as "A010 100-200+300 0", as the manual's examples of commands are
};

/// An Eppendorf PatchMan NP 2, written from its manual's command list and not from the driver: C001, C003, C004, C005,
/// C007, C008, C010, C012 and C013. What the manual does not show is assumed: errors are "ERR=nnn", the form that a
/// FemtoJet's manual prints; a go-to while it moves is such an error; an axis at its limit switch stands and tells bit
/// 2i (low) or 2i + 1 (high) of axis i. An error that is asked for answers the next command, which is not obeyed.
class EppendorfEmulator : public TextEmulator {
 public:
  explicit EppendorfEmulator(const EppendorfEmulatorConfig& config = {})
      : TextEmulator(config.answer_time), config_(config) {}

  Eigen::Vector3d position() const override { return place_ * config_.microstep; }
  void shiftByHand(const Eigen::Vector3d& way) override;
  bool isRemote() const { return remote_; }

 protected:
  void handleCommand(const std::string& command, double time) override;
  void move(double time, double dt) override;
  std::string error(int code) const override;
  void interrupt(double time) override;
  void switchOn() override;

 private:
  void goTo(const std::array<long, 6>& numbers, const std::string& answer_at_end);
  void stand(double time);
  void stop();
  int limits() const;
  std::string positionText() const;

  EppendorfEmulatorConfig config_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // microsteps
  Eigen::Vector3d speeds_ = Eigen::Vector3d::Zero();                                 // microsteps/s
  bool remote_ = false;
  std::string at_end_;  // to be answered when it stands; empty: nothing
};

}  // namespace microinjection
