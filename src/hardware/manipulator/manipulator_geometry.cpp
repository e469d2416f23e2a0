#include "hardware/manipulator/manipulator_geometry.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "hardware/manipulator/rig_model.h"

namespace microinjection {
namespace {

ManipulatorGeometry::Axis toAxis(const std::string& xml, const urdf::Joint& joint) {
  const auto& limits = joint.limits;
  if (!limits || !(limits->lower <= 0 && 0 <= limits->upper && limits->lower < limits->upper) ||
      !(limits->velocity > 0)) {
    throw ConfigError("URDF: joint " + joint.name + ": limits must hold lower <= 0 <= upper and velocity > 0");
  }
  return {joint.name, limits->lower, limits->upper, limits->velocity, accelerationLimit(xml, joint.name)};
}

void checkTilt(const urdf::Joint& joint, double angle) {
  if (!joint.limits) throw ConfigError("URDF: joint " + joint.name + ": limits are missing");
  if (angle >= joint.limits->lower && angle <= joint.limits->upper) return;
  std::ostringstream text;
  text << "tilt of the pipette: " << joint.name << " = " << angle << " rad, the URDF allows [" << joint.limits->lower
       << ", " << joint.limits->upper << "] rad";
  throw ConfigError(text.str());
}

void addOutside(std::ostringstream& reason, const std::string& joint, double value, double low, double high,
                const char* unit) {
  reason << (reason.tellp() > 0 ? "; " : "") << joint << " = " << value << " " << unit << ", allowed [" << low << ", "
         << high << "] " << unit;
}

}  // namespace

ManipulatorGeometry ManipulatorGeometry::fromUrdf(const std::string& xml, double tilt_angle, const std::string& tip) {
  const urdf::ModelInterfaceSharedPtr model = parseRig(xml);
  ManipulatorGeometry geometry;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::size_t axis = 0;
  for (const auto& joint : chainTo(*model, tip)) {
    pose = pose * toEigen(joint->parent_to_joint_origin_transform);
    if (joint->type == urdf::Joint::FIXED) continue;
    if (joint->type == urdf::Joint::PRISMATIC && axis < 3) {
      geometry.directions.col(axis) = pose.linear() * unitAxis(*joint);
      geometry.axes[axis++] = toAxis(xml, *joint);
    } else if (joint->type == urdf::Joint::REVOLUTE && axis == 3 && geometry.tilt.joint.empty()) {
      checkTilt(*joint, tilt_angle);
      geometry.tilt = ManipulatorGeometry::Tilt{joint->name, tilt_angle};
      pose.rotate(Eigen::AngleAxisd(tilt_angle, unitAxis(*joint)));
    } else {
      throw ConfigError("URDF: joint " + joint->name +
                        ": allowed are three prismatic joints, behind them one revolute joint, the others fixed");
    }
  }
  if (axis != 3) throw ConfigError("URDF: between world and " + tip + " must be three prismatic joints");
  if (std::abs(geometry.directions.determinant()) < 1e-3)
    throw ConfigError("URDF: the three axes must not lie in a plane");
  if (geometry.tilt.joint.empty() && tilt_angle != 0)
    throw ConfigError("tilt of the pipette: the URDF has no revolute joint behind the third axis, so it must be 0");
  geometry.tip_at_zero = pose;
  return geometry;
}

Eigen::Vector3d ManipulatorGeometry::tip(const Eigen::Vector3d& joints) const {
  return tip_at_zero.translation() + directions * joints;
}

Eigen::Isometry3d ManipulatorGeometry::tipPose(const Eigen::Vector3d& joints) const {
  Eigen::Isometry3d pose = tip_at_zero;
  pose.translation() = tip(joints);
  return pose;
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
    addOutside(reason, axis.joint, joints[i], axis.lower, axis.upper, "m");
  }
  return reason.str();
}

std::string ManipulatorGeometry::leavesTravel(const Eigen::Vector3d& from, const Eigen::Vector3d& joints) const {
  Eigen::Vector3d farther = joints;
  for (int i = 0; i < 3; ++i) {
    const Axis& axis = axes[i];
    const double low = std::min(axis.lower, from[i]), high = std::max(axis.upper, from[i]);
    if (joints[i] >= low && joints[i] <= high) farther[i] = std::clamp(joints[i], axis.lower, axis.upper);
  }
  return outsideTravel(farther);
}

std::string ManipulatorGeometry::tooFast(const Eigen::Vector3d& joint_velocity) const {
  std::ostringstream reason;
  for (int i = 0; i < 3; ++i) {
    const Axis& axis = axes[i];
    if (std::abs(joint_velocity[i]) <= axis.velocity) continue;
    addOutside(reason, axis.joint + " velocity", joint_velocity[i], -axis.velocity, axis.velocity, "m/s");
  }
  return reason.str();
}

}  // namespace microinjection
