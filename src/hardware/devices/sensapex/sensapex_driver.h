#pragma once

#include "hardware/devices/polled_manipulator.h"

namespace microinjection {

struct SensapexConfig : PolledManipulatorConfig {
  static constexpr int kBaud = 4000000;  ///< bit/s; of the time that a message takes, less than on any network

  SensapexConfig() { port.baud = kBaud; }

  int device = 1;              ///< its number in the network
  double resolution = 0.2e-6;  ///< m, of positions; a goal is reached within half of it

  static SensapexConfig read(ConfigReader& reader);
};

/// Driver of the Sensapex uMp-3 and uMp-4, over UDP. The device tells nm, which tremble, and ends a
/// move some tens of nm beside its goal. So a count is coarser, and a position is kept until it has
/// changed by more than 0.6 counts. Each axis has a speed of its own: whole um/s, below 1 um/s whole nm/s. Of a uMp-4
/// the fourth axis is not moved, and positions are not valid while it is elsewhere than at the start.
///
/// The device does not tell that it rests: a move is over when its time is and it is at its goal.
class SensapexDriver : public PolledManipulator {
 public:
  SensapexDriver(const SensapexConfig& config, std::unique_ptr<Wire> wire);

 protected:
  std::string setup(int step) const override;
  std::string handleSetup(int step, const std::string& reply) override;
  std::optional<Eigen::Vector3d> readPosition(const std::string& reply) override;
  std::string settingQuery(const std::string& /*setting*/) const override { return "HELLO"; }
  bool isKept(const std::string& /*setting*/, const std::string& reply) const override { return reply == "kept"; }
  bool acknowledges(const std::string& /*line*/, const std::string& reply) const override { return reply == "A"; }
  Plan plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed,
            const Eigen::Vector3d& fastest) const override;
  double count() const override { return resolution_; }

 private:
  const double resolution_;              // m
  std::size_t axes_ = 0;                 // number of them
  std::optional<Eigen::Vector3d> told_;  // counts, of the last position
  std::optional<double> fourth_;         // nm, of the fourth axis at the start
};

}  // namespace microinjection
