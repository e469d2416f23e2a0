#pragma once

#include "hardware/devices/eppendorf/eppendorf_protocol.h"
#include "hardware/devices/polled_manipulator.h"

namespace microinjection {

struct EppendorfConfig : PolledManipulatorConfig {
  EppendorfConfig() { port.baud = 19200; }

  double microsteps_per_metre = 0;  ///< 1/m; 0: the device is told whole micrometres

  EppendorfUnit unit() const {
    return microsteps_per_metre > 0 ? EppendorfUnit::kMicrostep : EppendorfUnit::kMicrometre;
  }
  double count() const { return microsteps_per_metre > 0 ? 1 / microsteps_per_metre : 1e-6; }  ///< m

  static EppendorfConfig read(ConfigReader& reader);
};

/// Driver of the Eppendorf PatchMan NP 2 and TransferMan NK 2, and of the InjectMan NI 2 as far as
/// its protocol is the same. The device is under remote control while the driver is connected:
/// joystick and keys are locked, and released at the end. A count is a micrometre or a microstep,
/// and the speed of an axis is a whole number of counts per second. Slower paths are travelled in
/// steps, and long ones in parts that stay on the line. With microsteps the device must tell as many
/// for a micrometre as the file has; otherwise it is a fault, and nothing moves.
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
  double count() const override { return config_.count(); }
  std::string notArrivedReason() const override;

 private:
  std::string checkMicrosteps(const Eigen::Vector3d& microsteps) const;

  const EppendorfConfig config_;
  Eigen::Vector3d micrometres_ = Eigen::Vector3d::Zero();  // of the motors, at the start
  bool compared_ = false;                                  // positions in both units
  int limits_ = 0;                                         // of the last position
};

}  // namespace microinjection
