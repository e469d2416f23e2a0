#include "manipulator/manipulator_geometry.h"

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& r = pose.rotation;
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() << pose.position.x, pose.position.y, pose.position.z;
  return result;
}

/// Joints from `world` down to `needle_tip`.
std::vector<urdf::JointConstSharedPtr> chainToTip(const urdf::ModelInterface& model) {
  std::vector<urdf::JointConstSharedPtr> chain;
  urdf::LinkConstSharedPtr link = model.getLink("needle_tip");
  if (!link) throw ConfigError("URDF: link needle_tip is missing");
  while (link->parent_joint) {
    chain.push_back(link->parent_joint);
    link = link->getParent();
  }
  if (link->name != "world") throw ConfigError("URDF: needle_tip hangs on " + link->name + ", must hang on world");
  std::reverse(chain.begin(), chain.end());
  return chain;
}

ManipulatorGeometry::Axis toAxis(const urdf::Joint& joint) {
  const auto& limits = joint.limits;
  if (!limits || !(limits->lower <= 0 && 0 <= limits->upper && limits->lower < limits->upper) ||
      !(limits->velocity > 0)) {
    throw ConfigError("URDF: joint " + joint.name + ": limits must hold lower <= 0 <= upper and velocity > 0");
  }
  return {joint.name, limits->lower, limits->upper, limits->velocity};
}

}  // namespace

ManipulatorGeometry ManipulatorGeometry::fromUrdf(const std::string& xml) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(xml);
  if (!model) throw ConfigError("robot_description: is not a URDF");
  ManipulatorGeometry geometry;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::size_t axis = 0;
  for (const auto& joint : chainToTip(*model)) {
    pose = pose * toEigen(joint->parent_to_joint_origin_transform);
    if (joint->type == urdf::Joint::FIXED) continue;
    if (joint->type != urdf::Joint::PRISMATIC || axis == 3) {
      throw ConfigError("URDF: joint " + joint->name + ": allowed are three prismatic joints, the others fixed");
    }
    const Eigen::Vector3d direction(joint->axis.x, joint->axis.y, joint->axis.z);
    geometry.directions.col(axis) = pose.linear() * direction.normalized();
    geometry.axes[axis++] = toAxis(*joint);
  }
  if (axis != 3) throw ConfigError("URDF: between world and needle_tip must be three prismatic joints");
  if (std::abs(geometry.directions.determinant()) < 1e-3)
    throw ConfigError("URDF: the three axes must not lie in a plane");
  geometry.tip_at_zero = pose;
  return geometry;
}

Eigen::Vector3d ManipulatorGeometry::tip(const Eigen::Vector3d& joints) const {
  return tip_at_zero.translation() + directions * joints;
}

Eigen::Vector3d ManipulatorGeometry::joints(const Eigen::Vector3d& tip) const {
  return directions.inverse() * (tip - tip_at_zero.translation());
}

std::string ManipulatorGeometry::outsideTravel(const Eigen::Vector3d& joints) const {
  std::ostringstream reason;
  for (int i = 0; i < 3; ++i) {
    const Axis& axis = axes[i];
    const double slack = 1e-12;  // rounding of the inverse kinematics, m
    if (joints[i] >= axis.lower - slack && joints[i] <= axis.upper + slack) continue;
    reason << (reason.tellp() > 0 ? "; " : "") << axis.joint << " = " << joints[i] << " m, allowed [" << axis.lower
           << ", " << axis.upper << "] m";
  }
  return reason.str();
}

}  // namespace microinjection
