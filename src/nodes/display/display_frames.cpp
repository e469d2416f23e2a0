#include "nodes/display/display_frames.h"

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

#include "nodes/runtime/conversions.h"
#include "operation/display/display_scale.h"

namespace microinjection {
namespace {

geometry_msgs::TransformStamped enlarged(const std::string& frame, const Eigen::Isometry3d& pose, double enlargement,
                                         const ros::Time& stamp) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = "viz/world";
  message.child_frame_id = "viz/" + frame;
  message.transform.translation = toMessage<geometry_msgs::Vector3>(toDisplay(pose.translation(), enlargement));
  message.transform.rotation.x = rotation.x();
  message.transform.rotation.y = rotation.y();
  message.transform.rotation.z = rotation.z();
  message.transform.rotation.w = rotation.w();
  return message;
}

}  // namespace

DisplayFrames::DisplayFrames(const ros::NodeHandle& node, const std::vector<std::string>& fixed, double enlargement)
    : fixed_(fixed), enlargement_(enlargement), frames_(node) {}

std::optional<Eigen::Isometry3d> DisplayFrames::find(const std::string& parent, const std::string& frame) const {
  return frames_.find(parent, frame);
}

void DisplayFrames::update() {
  for (const std::string& frame : fixed_) {
    const std::optional<Eigen::Isometry3d> pose = find("world", frame);
    if (!pose) continue;
    const auto last = published_.find(frame);
    if (last != published_.end() && last->second.matrix() == pose->matrix()) continue;
    static_broadcaster_.sendTransform(enlarged(frame, *pose, enlargement_, ros::Time::now()));
    published_[frame] = *pose;
  }
}

void DisplayFrames::publishNeedleTip(const Eigen::Isometry3d& tip) {
  // tf refuses two transforms with the same stamp, as while a simulated clock stands still.
  const ros::Time now = ros::Time::now();
  if (now.toSec() == tip_stamp_) return;
  broadcaster_.sendTransform(enlarged("needle_tip", tip, enlargement_, now));
  tip_stamp_ = now.toSec();
}

std::vector<std::string> DisplayFrames::missing() const {
  std::vector<std::string> names;
  for (const std::string& frame : fixed_) {
    if (!published_.count(frame)) names.push_back(frame);
  }
  return names;
}

}  // namespace microinjection
