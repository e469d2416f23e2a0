#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace microinjection {

/// Parses the rig's URDF. @throws ConfigError if the text is no URDF.
urdf::ModelInterfaceSharedPtr parseRig(const std::string& xml);

Eigen::Isometry3d toEigen(const urdf::Pose& pose);

/// Joints from `world` to a link, starting at `world`.
/// @throws ConfigError if the link is missing or not connected to `world`.
std::vector<urdf::JointConstSharedPtr> chainTo(const urdf::ModelInterface& model, const std::string& link);

/// The joint axis as a unit vector in the joint's frame. @throws ConfigError for a zero axis.
Eigen::Vector3d unitAxis(const urdf::Joint& joint);

/// Attribute `acceleration` (m/s^2) of a joint's <limit>, which the URDF parser of Debian 12
/// ignores.
/// @throws ConfigError with joint and attribute if it is missing or not above 0.
double accelerationLimit(const std::string& xml, const std::string& joint);

}  // namespace microinjection
