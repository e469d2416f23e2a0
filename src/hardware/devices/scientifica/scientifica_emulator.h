#pragma once

#include <map>
#include <string>
#include <vector>

#include "hardware/devices/text_emulator.h"

namespace microinjection {

struct ScientificaEmulatorConfig {
  std::string version = "3.12";  ///< firmware, reply to VER; version 3 and later have other units
  double scale = 0;              ///< UUX or USTEP as reported; 0: a PatchStar's, -6.4 or 1600
  std::string maker = "Y519";    ///< reply to SCIENTIFICA
  double travel = 10e-3;         ///< m, to either side of 0; assumed
  double answer_time = 3e-3;     ///< s, from the end of a command to the start of its reply; assumed
};

/// Emulates a Scientifica PatchStar. It is based on the device's clients and their notes on the
/// motion card's command list, not on the driver: SCIENTIFICA, VER, DATE, TYPE, DESC, POS and P, PX
/// and "PX 0", ABS, ABSZ, REL, VJ, S, STOP, TOP, FIRST, ACC, UUX.., USTEP, ZERO, LIMITS, CURRENT, and
/// the settings of its hand control. Commands may be in lower case, settings may have decimals, and
/// "px = 0" is "PX 0". Assumed: it counts from 0
/// where it is switched on, with the settings of delivery; one straight line with the speed along it
/// and linear ramps; "E,3" for an unknown command (ScanImage notes it for one command); no reply to
/// an ABS while moving (acq4's note). An injected error answers the next command, which is not
/// executed.
class ScientificaEmulator : public TextEmulator {
 public:
  explicit ScientificaEmulator(const ScientificaEmulatorConfig& config = {});

  Eigen::Vector3d position() const override { return position_ / kStepsPerMetre; }
  void shiftByHand(const Eigen::Vector3d& displacement) override {
    position_ = (position_ + displacement * kStepsPerMetre).array().round();
  }

 protected:
  void handleCommand(const std::string& command, double time) override;
  void move(double time, double dt) override;
  std::string error(int code) const override { return "E," + std::to_string(code); }
  void interrupt(double time) override;
  void switchOn() override;

 private:
  static constexpr double kStepsPerMetre = 64e6;  // a motor's step is 1/64 um

  bool isOld() const { return config_.version[0] < '3'; }
  double stepsPerCount() const { return isOld() ? 6.4 : 0.64; }
  double stepsPerSecond(int top) const;  // from TOP or FIRST
  double acceleration() const;           // steps/s^2
  bool replyToQuery(std::vector<std::string> words, double time);
  bool set(const std::vector<std::string>& words, double time);
  void goTo(const std::vector<std::string>& words, bool relative, double time);
  void goToEnds(const std::vector<std::string>& words, double time);
  void begin(const Eigen::Vector3d& end, double time);
  void count(const Eigen::Vector3d& position, double time);
  std::string textOf(int axis) const;  // its position, counts

  ScientificaEmulatorConfig config_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // steps
  int top_ = 0, first_ = 0, acc_ = 0;                                                   // settings
  std::map<std::string, int> of_the_knobs_;  // settings of its hand control, which say nothing here
  double speed_ = 0;                         // steps/s, present
  double move_top_ = 0, move_least_ = 0;     // steps/s, of this move
  bool stopping_ = false;
  std::string description_ = "PatchStar";
};

}  // namespace microinjection
