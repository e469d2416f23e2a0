#include "operation/teleoperation/force_source.h"

#include "base/vectors.h"

namespace microinjection {

ForceSourceConfig ForceSourceConfig::read(ConfigReader& reader) {
  ForceSourceConfig config;
  reader.choice("force_source", config.source, {"predicted", "measured", "blend"});
  reader.number("measured_share", config.measured_share, Range::closed(0, 1));
  return config;
}

std::optional<Eigen::Vector3d> chooseForce(const ForceSourceConfig& config, const TipForces& forces) {
  if (config.usesPredicted() && !isValid(forces.predicted)) return std::nullopt;
  if (config.usesMeasured() && !isValid(forces.measured)) return std::nullopt;
  if (!config.usesMeasured()) return forces.predicted;
  if (!config.usesPredicted()) return forces.measured;
  return Eigen::Vector3d(*forces.predicted + config.measured_share * (*forces.measured - *forces.predicted));
}

}  // namespace microinjection
