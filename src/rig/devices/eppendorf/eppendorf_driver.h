#pragma once

#include "rig/devices/polled_manipulator.h"

namespace microinjection {

struct EppendorfConfig : PolledManipulatorConfig {
  EppendorfConfig() { port.baud = 19200; }

  static EppendorfConfig read(ConfigReader& reader);
};

/// Driver of the Eppendorf PatchMan NP 2, and of the InjectMan NI 2 as far as its protocol is the
/// same. The device is under remote control while the driver is connected: joystick and keys are
/// locked, and released at the end. A count is a micrometre, and the speed of an axis is a whole
/// number of micrometres per second. Slower paths are travelled in steps, and long ones in parts
/// that stay on the line.
class EppendorfDriver : public PolledManipulator {
 public:
  EppendorfDriver(const EppendorfConfig& config, std::unique_ptr<Wire> wire);

 protected:
  std::string setup(int step) const override;
  std::string handleSetup(int step, const std::string& reply) override;
  std::optional<Eigen::Vector3d> readPosition(const std::string& reply) override;
  std::string settingQuery(const std::string& setting) const override;
  bool isKept(const std::string& setting, const std::string& reply) const override;
  bool acknowledges(const std::string& line, const std::string& reply) const override;
  Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
            const Eigen::Vector3d& fastest) const override;
  double count() const override { return 1e-6; }
  std::string notArrivedReason() const override;

 private:
  int limits_ = 0;  // of the last position
};

}  // namespace microinjection
