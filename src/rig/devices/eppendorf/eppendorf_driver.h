#pragma once

#include "rig/devices/eppendorf/eppendorf_config.h"
#include "rig/devices/polled_manipulator.h"

namespace microinjection {

/// Eppendorf PatchMan NP 2, and InjectMan NI 2 as far as it speaks alike. It is under remote control while the driver
/// has it: joystick and keys are locked, and given back at its end. A count is a micrometre.
class EppendorfDriver : public PolledManipulator {
 public:
  EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire);
  ~EppendorfDriver() override;

 protected:
  std::string setup(int step) const override;
  std::string takeSetup(int step, const std::string& answer) override;
  std::optional<Eigen::Vector3d> readPosition(const std::string& answer) override;
  bool acknowledges(const std::string& line, const std::string& answer) const override;
  Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
            const Eigen::Vector3d& fastest) override;
  double count() const override { return 1e-6; }
  double slowest() const override { return 1e-6; }
  std::string whyNotArrived() const override;

 private:
  int limits_ = 0;  // of the last position
};

}  // namespace microinjection
