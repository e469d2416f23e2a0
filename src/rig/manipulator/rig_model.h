#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace microinjection {

/// The rig's file as a tree of links. @throws ConfigError when the text is no URDF.
urdf::ModelInterfaceSharedPtr parseRig(const std::string& xml);

Eigen::Isometry3d toEigen(const urdf::Pose& pose);

/// Joints from `world` down to a link, those nearest to `world` first.
/// @throws ConfigError when the link is missing or does not hang on `world`.
std::vector<urdf::JointConstSharedPtr> chainTo(const urdf::ModelInterface& model, const std::string& link);

/// The joint axis as a unit vector in the joint's frame. @throws ConfigError when it is none.
Eigen::Vector3d unitAxis(const urdf::Joint& joint);

/// Attribute `acceleration` (m/s^2) of a joint's <limit>, which the URDF reader of Debian 12 passes over.
/// @throws ConfigError naming joint and attribute when it is missing or not above 0.
double accelerationLimit(const std::string& xml, const std::string& joint);

}  // namespace microinjection
