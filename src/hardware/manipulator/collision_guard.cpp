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
  Eigen::Matrix3d others;      ///< of each joint of the second manipulator
};

/// Whether a joint is one of the manipulator's; an axis is entered into `directions`, a tilt turns `pose`.
bool isCarriedBy(const urdf::Joint& joint, const ManipulatorGeometry& geometry, Eigen::Matrix3d& directions,
                 Eigen::Isometry3d& pose) {
  for (int i = 0; i < 3; ++i) {
    if (joint.name != geometry.axes[i].joint) continue;
    directions.col(i) = geometry.directions.col(i);
    return true;
  }
  if (joint.name != geometry.tilt.joint) return false;
  pose.rotate(Eigen::AngleAxisd(geometry.tilt.angle, unitAxis(joint)));
  return true;
}

LinkPose linkPose(const urdf::ModelInterface& model, const std::string& link, const ManipulatorGeometry& geometry,
                  const ManipulatorGeometry* other) {
  LinkPose link_pose{Eigen::Isometry3d::Identity(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  for (const auto& joint : chainTo(model, link)) {
    link_pose.pose = link_pose.pose * toEigen(joint->parent_to_joint_origin_transform);
    const bool supported = joint->type == urdf::Joint::FIXED ||
                           isCarriedBy(*joint, geometry, link_pose.directions, link_pose.pose) ||
                           (other && isCarriedBy(*joint, *other, link_pose.others, link_pose.pose));
    if (!supported) {
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

/// A <collision> shape of a link.
struct CollisionGuard::Shape {
  std::string link;
  Motion motion;
  Solid solid;  ///< with all joints at 0

  bool isOwn() const { return !motion.own.isZero(); }
  bool isOther() const { return !motion.other.isZero(); }
};

CollisionGuard::CollisionGuard(const std::string& xml, const ManipulatorGeometry& geometry, double margin,
                               const ManipulatorGeometry* other, Role role)
    : margin_(margin) {
  const urdf::ModelInterfaceSharedPtr model = parseRig(xml);
  std::vector<Shape> shapes;
  for (const auto& [name, link] : model->links_) {
    for (const auto& collision : link->collision_array) {
      if (!collision->geometry) throw ConfigError("URDF: link " + name + ": <collision> has no geometry");
      const LinkPose link_pose = linkPose(*model, name, geometry, other);
      const Solid solid = toSolid(*collision->geometry, link_pose.pose * toEigen(collision->origin), name);
      shapes.push_back({name, {link_pose.directions, link_pose.others}, solid});
    }
  }
  const bool is_solid = role == Role::kSolid;
  for (const Shape& own : shapes) {
    if (!own.isOwn()) continue;
    const Capsule capsule = toCapsule(own.solid, own.link);
    for (const Shape& shape : shapes) {
      if (shape.isOwn()) continue;
      if (is_solid && shape.isOther()) {
        addPair(shape, own);
      } else if (!is_solid || distance(capsule, Eigen::Vector3d::Zero(), shape.solid) > 0) {
        addPair(own, shape);
      }
    }
  }
}

void CollisionGuard::addPair(const Shape& capsule, const Shape& solid) {
  const bool moves = capsule.isOwn();
  const Motion motion{capsule.motion.own - solid.motion.own, capsule.motion.other - solid.motion.other};
  pairs_.push_back({moves ? capsule.link : solid.link, moves ? solid.link : capsule.link, motion,
                    toCapsule(capsule.solid, capsule.link), solid.solid});
}

std::string CollisionGuard::reason(const Pair& pair, double distance) const {
  std::ostringstream text;
  if (distance <= 0) {
    text << pair.mover << " would run into " << pair.obstacle;
  } else {
    text << pair.mover << " would come within " << distance << " m of " << pair.obstacle;
  }
  text << ", allowed " << margin_ << " m";
  return text.str();
}

std::string CollisionGuard::blocks(const Eigen::Vector3d& joints) const {
  for (const Pair& pair : pairs_) {
    const double there = distance(pair.capsule, offset(pair, joints), pair.solid, margin_);
    if (there < margin_) return reason(pair, there);
  }
  return "";
}

std::string CollisionGuard::blocksPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  for (const Pair& pair : pairs_) {
    const Eigen::Vector3d start = offset(pair, from), end = offset(pair, to);
    const double nearest = distanceAlongPath(pair.capsule, start, end, pair.solid, margin_);
    if (nearest >= margin_ - kSlack) continue;
    const double at_start = distance(pair.capsule, start, pair.solid);
    if (nearest < std::min(margin_, at_start) - kSlack) return reason(pair, nearest);
  }
  return "";
}

double CollisionGuard::clearance(const Eigen::Vector3d& joints) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Pair& pair : pairs_)
    smallest = std::min(smallest, distance(pair.capsule, offset(pair, joints), pair.solid, smallest));
  return std::max(0.0, smallest);
}

}  // namespace microinjection
