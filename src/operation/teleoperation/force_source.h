#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct ForceSourceConfig {
  std::string source = "predicted";  ///< predicted, measured or blend
  double measured_share = 0.5;       ///< 1, of the measured force in the blend

  bool usesPredicted() const { return source != "measured"; }
  bool usesMeasured() const { return source != "predicted"; }
  /// Keys force_source and measured_share.
  static ForceSourceConfig read(ConfigReader& reader);
};

struct TipForces {
  std::optional<Eigen::Vector3d> predicted;  ///< N, of the cell model; empty: absent or stale
  std::optional<Eigen::Vector3d> measured;   ///< N, of the force sensor; empty: absent or stale
};

/// Returns the tip force (N) to reflect; empty when a required source is missing or not finite. A
/// blend is not rendered from one source alone: the force would change for a reason that the
/// operator cannot feel.
std::optional<Eigen::Vector3d> chooseForce(const ForceSourceConfig& config, const TipForces& forces);

}  // namespace microinjection
