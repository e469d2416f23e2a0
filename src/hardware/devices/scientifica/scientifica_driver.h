#pragma once

#include "hardware/devices/polled_manipulator.h"

namespace microinjection {

struct ScientificaConfig : PolledManipulatorConfig {
  ScientificaConfig() {
    port.baud = 38400;
    reply_timeout = 0.35;
  }

  int version = 3;             ///< of the motion card: 2 or 3; others are refused
  double acceleration = 0.03;  ///< m/s^2, set in the device at the start

  static ScientificaConfig read(ConfigReader& reader);
};

/// Driver of the Scientifica PatchStar, and of other manipulators with the same motion cards and
/// step size. At the start the card must confirm the maker Scientifica, the version in the file,
/// and the scale at which that version's positions have their known unit. Anything else is a fault
/// with the reply, and nothing moves. Then the driver sets the acceleration, and the smallest start
/// speed. Every setting is read back, also the speed before each move, because the line may have
/// changed one of its digits.
class ScientificaDriver : public PolledManipulator {
 public:
  ScientificaDriver(const ScientificaConfig& config, std::unique_ptr<Wire> wire);

 protected:
  std::string setup(int step) const override;
  std::string handleSetup(int step, const std::string& reply) override;
  std::optional<Eigen::Vector3d> readPosition(const std::string& reply) override;
  std::optional<bool> readMotion(const std::string& reply) const override;
  bool isReadBack(int step) const override;
  std::string settingQuery(const std::string& setting) const override;
  bool isKept(const std::string& setting, const std::string& reply) const override;
  bool acknowledges(const std::string& line, const std::string& reply) const override;
  Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
            const Eigen::Vector3d& fastest) const override;
  double count() const override;
  double arrival() const override;

 private:
  const ScientificaConfig config_;
};

}  // namespace microinjection
