#pragma once

#include "rig/devices/polled_manipulator.h"
#include "rig/devices/scientifica/scientifica_config.h"

namespace microinjection {

/// Scientifica PatchStar, and other manipulators on the same motion cards whose steps are as long. At the begin the
/// card must say what it is: that it is Scientifica's, the version that the file names, and the scale at which that
/// version's positions have their known unit. Anything else is a fault that tells the answer, and nothing moves. Then
/// its acceleration is set, and its start speed to the smallest.
class ScientificaDriver : public PolledManipulator {
 public:
  ScientificaDriver(const ScientificaConfig& config, std::unique_ptr<Wire> wire);

 protected:
  std::string setup(int step) const override;
  std::string takeSetup(int step, const std::string& answer) override;
  std::optional<Eigen::Vector3d> readPosition(const std::string& answer) override;
  std::optional<bool> readMotion(const std::string& answer) const override;
  std::string askKept(const std::string& setting) const override;
  bool isKept(const std::string& setting, const std::string& answer) const override;
  bool acknowledges(const std::string& line, const std::string& answer) const override;
  Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
            const Eigen::Vector3d& fastest) const override;
  double count() const override;
  double arrival() const override;

 private:
  const ScientificaConfig config_;
};

}  // namespace microinjection
