#include "hardware/manipulator/collision_guard.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "base/errors.h"
#include "hardware/manipulator/rig_model.h"

namespace microinjection {
namespace {

constexpr double kSlack = 1e-9;  // m, so that a pose exactly at the margin can start and end a path

struct LinkPose {
  Eigen::Isometry3d pose;      ///< of the link in `world`, all three joints at 0
  Eigen::Matrix3d directions;  ///< displacement in `world` per displacement of each joint
};

LinkPose linkPose(const urdf::ModelInterface& model, const std::string& link, const ManipulatorGeometry& geometry) {
  LinkPose link_pose{Eigen::Isometry3d::Identity(), Eigen::Matrix3d::Zero()};
  for (const auto& joint : chainTo(model, link)) {
    link_pose.pose = link_pose.pose * toEigen(joint->parent_to_joint_origin_transform);
    bool supported = joint->type == urdf::Joint::FIXED;
    for (int i = 0; i < 3; ++i) {
      if (joint->name != geometry.axes[i].joint) continue;
      link_pose.directions.col(i) = geometry.directions.col(i);
      supported = true;
    }
    if (joint->name == geometry.tilt.joint) {
      link_pose.pose.rotate(Eigen::AngleAxisd(geometry.tilt.angle, unitAxis(*joint)));
    } else if (!supported) {
      throw ConfigError("URDF: link " + link + ": its <collision> moves with " + joint->name +
                        ", which is no axis of the manipulator");
    }
  }
  return link_pose;
}

Solid toSolid(const urdf::Geometry& shape, const Eigen::Isometry3d& pose, const std::string& link) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&shape))
    return {Solid::Shape::kBox, pose, Eigen::Vector3d(box->dim.x, box->dim.y, box->dim.z) / 2};
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&shape))
    return {Solid::Shape::kCylinder, pose, {cylinder->radius, 0, cylinder->length / 2}};
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&shape))
    return {Solid::Shape::kSphere, pose, {sphere->radius, 0, 0}};
  throw ConfigError("URDF: link " + link + ": <collision> must be a box, a cylinder or a sphere");
}

Capsule toCapsule(const Solid& solid, const std::string& link) {
  if (solid.shape == Solid::Shape::kBox)
    throw ConfigError("URDF: link " + link + " moves: its <collision> must be a cylinder or a sphere");
  const Eigen::Vector3d along = solid.pose.linear().col(2) * solid.half.z();
  return {solid.pose.translation() - along, solid.pose.translation() + along, solid.half.x()};
}

}  // namespace

CollisionGuard::CollisionGuard(const std::string& xml, const ManipulatorGeometry& geometry, double margin)
    : margin_(margin) {
  const urdf::ModelInterfaceSharedPtr model = parseRig(xml);
  for (const auto& [name, link] : model->links_) {
    for (const auto& collision : link->collision_array) {
      if (!collision->geometry) throw ConfigError("URDF: link " + name + ": <collision> has no geometry");
      const LinkPose link_pose = linkPose(*model, name, geometry);
      const Solid solid = toSolid(*collision->geometry, link_pose.pose * toEigen(collision->origin), name);
      if (link_pose.directions.isZero()) {
        obstacles_.push_back({name, solid});
      } else {
        movers_.push_back({name, link_pose.directions, toCapsule(solid, name)});
      }
    }
  }
}

std::string CollisionGuard::reason(const Mover& mover, const Obstacle& obstacle, double distance) const {
  std::ostringstream text;
  if (distance <= 0) {
    text << mover.link << " would run into " << obstacle.link;
  } else {
    text << mover.link << " would come within " << distance << " m of " << obstacle.link;
  }
  text << ", allowed " << margin_ << " m";
  return text.str();
}

std::string CollisionGuard::blocks(const Eigen::Vector3d& joints) const {
  for (const Mover& mover : movers_) {
    const Eigen::Vector3d offset = mover.directions * joints;
    for (const Obstacle& obstacle : obstacles_) {
      const double there = distance(mover.capsule, offset, obstacle.solid, margin_);
      if (there < margin_) return reason(mover, obstacle, there);
    }
  }
  return "";
}

std::string CollisionGuard::blocksPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  for (const Mover& mover : movers_) {
    const Eigen::Vector3d start = mover.directions * from;
    const Eigen::Vector3d end = mover.directions * to;
    for (const Obstacle& obstacle : obstacles_) {
      const double nearest = distanceAlongPath(mover.capsule, start, end, obstacle.solid, margin_);
      if (nearest >= margin_ - kSlack) continue;
      const double at_start = distance(mover.capsule, start, obstacle.solid);
      if (nearest < std::min(margin_, at_start) - kSlack) return reason(mover, obstacle, nearest);
    }
  }
  return "";
}

double CollisionGuard::clearance(const Eigen::Vector3d& joints) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Mover& mover : movers_) {
    for (const Obstacle& obstacle : obstacles_) {
      smallest = std::min(smallest, distance(mover.capsule, mover.directions * joints, obstacle.solid, smallest));
    }
  }
  return std::max(0.0, smallest);
}

}  // namespace microinjection
