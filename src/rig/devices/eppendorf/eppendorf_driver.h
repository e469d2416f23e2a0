#pragma once

#include "rig/devices/eppendorf/eppendorf_config.h"
#include "rig/devices/polled_manipulator.h"

namespace microinjection {

/// Eppendorf PatchMan NP 2, and InjectMan NI 2 as far as it speaks alike. It is under remote control while the driver
/// has it: joystick and keys are locked, and given back at its end. A count is a micrometre, and the speed of an axis
/// is whole micrometres a second: slower ways are gone in steps, and long ones in parts that keep to the line.
class EppendorfDriver : public PolledManipulator {
 public:
  EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire);

 protected:
  std::string setup(int step) const override;
  std::string takeSetup(int step, const std::string& answer) override;
  std::optional<Eigen::Vector3d> readPosition(const std::string& answer) override;
  std::string askKept(const std::string& setting) const override;
  bool isKept(const std::string& setting, const std::string& answer) const override;
  bool acknowledges(const std::string& line, const std::string& answer) const override;
  Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
            const Eigen::Vector3d& fastest) const override;
  double count() const override { return 1e-6; }
  std::string whyNotArrived() const override;

 private:
  int limits_ = 0;  // of the last position
};

}  // namespace microinjection
