#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct VirtualFixturesConfig {
  bool guide = false;                                     ///< a line to the cell's centre
  Eigen::Vector3d guide_point = Eigen::Vector3d::Zero();  ///< m, `world`, on the line: the cell's centre
  Eigen::Vector3d guide_axis = Eigen::Vector3d::UnitZ();  ///< direction of the line; any length but 0
  double guide_stiffness = 30;                            ///< N/m at the hand, across the line
  double guide_force = 0.5;                               ///< N, largest pull of the line: the hand can leave it

  bool wall = false;                                       ///< a plane before the holding pipette
  Eigen::Vector3d wall_point = {0, 0, -40e-6};             ///< m, `world`
  Eigen::Vector3d wall_normal = Eigen::Vector3d::UnitZ();  ///< towards the allowed side; any length but 0

  bool workspace = false;                                 ///< a box
  Eigen::Vector3d workspace_low = {-2e-3, -2e-3, -2e-3};  ///< m, `world`
  Eigen::Vector3d workspace_high = {2e-3, 2e-3, 2e-3};    ///< m, `world`

  double limit_stiffness = 300;  ///< N/m at the hand, of wall and box
  double limit_force = 2.0;      ///< N, largest push of each

  /// A direction of zero and a box whose low is not below its high are errors.
  static VirtualFixturesConfig read(ConfigReader reader);
};

/// Virtual fixtures (Rosenberg 1993). The guide pulls towards a line. Wall and box limit the target
/// and push the hand back, in proportion to its distance beyond them. Stiffnesses are at the hand's
/// scale: a lateral error e of the needle is e / position_scale of the hand.
class VirtualFixtures {
 public:
  struct Result {
    Eigen::Vector3d target;      ///< m, within the limits
    Eigen::Vector3d hand_force;  ///< N, at the hand, axes as `world`
  };

  VirtualFixtures(const VirtualFixturesConfig& config, double position_scale);

  Result apply(const Eigen::Vector3d& target) const;

 private:
  Eigen::Vector3d insideLimits(Eigen::Vector3d target) const;

  VirtualFixturesConfig config_;
  double position_scale_;
};

}  // namespace microinjection
