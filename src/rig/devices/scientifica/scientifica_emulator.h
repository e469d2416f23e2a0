#pragma once

#include <string>
#include <vector>

#include "rig/devices/text_emulator.h"

namespace microinjection {

struct ScientificaEmulatorConfig {
  std::string version = "3.12";  ///< firmware, as VER tells; from 3 on the units are others
  double scale = 0;              ///< UUX or USTEP as told; 0: a PatchStar's, -6.4 or 1600
  std::string maker = "Y519";    ///< its answer to SCIENTIFICA
  double travel = 10e-3;         ///< m, to either side of 0; assumed
  double answer_time = 3e-3;     ///< s, from a command's end to its answer's begin; assumed
};

/// A Scientifica PatchStar, written from what its clients say and note of the motion card's command list, and not from
/// the driver: SCIENTIFICA, VER, DATE, TYPE, DESC, POS and P, ABS, REL, S, STOP, TOP, FIRST, ACC, UUX.., USTEP, ZERO,
/// LIMITS. Words may be small. Assumed: it counts from 0 where it is switched on, with the settings of delivery; one
/// straight line with the speed along it and linear ramps; "E,3" for what it does not know (ScanImage notes it of one
/// command); no answer to an ABS while it moves (acq4's note). An error that is asked for answers the next command,
/// which is not obeyed.
class ScientificaEmulator : public TextEmulator {
 public:
  explicit ScientificaEmulator(const ScientificaEmulatorConfig& config = {});

  Eigen::Vector3d position() const override { return place_ / kStepsPerMetre; }
  void shiftByHand(const Eigen::Vector3d& way) override { place_ = (place_ + way * kStepsPerMetre).array().round(); }

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
  double stepsPerSecond(int top) const;  // of a setting of TOP or FIRST
  double acceleration() const;           // steps/s^2
  bool tell(const std::vector<std::string>& words, double time);
  bool set(const std::vector<std::string>& words, double time);
  void goTo(const std::vector<std::string>& words, bool relative, double time);
  std::string positionText() const;

  ScientificaEmulatorConfig config_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero(), end_ = Eigen::Vector3d::Zero();  // steps
  int top_ = 0, first_ = 0, acc_ = 0;                                                // as they are set
  double speed_ = 0;                                                                 // steps/s, now
  bool stopping_ = false;
};

}  // namespace microinjection
