#include "nodes/display/display_frames.h"

#include <algorithm>

#include "nodes/runtime/conversions.h"
#include "operation/display/display_scale.h"

namespace microinjection {
namespace {

geometry_msgs::TransformStamped enlarged(const std::string& frame, Eigen::Isometry3d pose, double enlargement,
                                         const ros::Time& stamp) {
  pose.translation() = toDisplay(pose.translation(), enlargement);
  return toTransform(pose, stamp, "viz/world", "viz/" + frame);
}

}  // namespace

DisplayFrames::DisplayFrames(Bus& bus, const std::vector<std::string>& fixed, double enlargement)
    : bus_(bus),
      fixed_(fixed),
      enlargement_(enlargement),
      frames_(bus),
      tf_(bus.advertise<tf2_msgs::TFMessage>("/tf", 100)),
      static_tf_(bus.advertise<tf2_msgs::TFMessage>("/tf_static", 100, true)) {}

std::optional<Eigen::Isometry3d> DisplayFrames::find(const std::string& parent, const std::string& frame) const {
  return frames_.find(parent, frame);
}

void DisplayFrames::update() {
  for (const std::string& frame : fixed_) {
    const std::optional<Eigen::Isometry3d> pose = find("world", frame);
    if (!pose) continue;
    const auto last = published_.find(frame);
    if (last != published_.end() && last->second.matrix() == pose->matrix()) continue;
    publishFixed(enlarged(frame, *pose, enlargement_, bus_.now()));
    published_[frame] = *pose;
  }
}

void DisplayFrames::publishFixed(const geometry_msgs::TransformStamped& transform) {
  auto& all = fixed_message_.transforms;
  const auto last = std::find_if(all.begin(), all.end(),
                                 [&](const auto& each) { return each.child_frame_id == transform.child_frame_id; });
  if (last != all.end()) {
    *last = transform;
  } else {
    all.push_back(transform);
  }
  static_tf_.publish(fixed_message_);
}

void DisplayFrames::publishNeedleTip(const Eigen::Isometry3d& tip) {
  // tf refuses two transforms with the same stamp, as while a simulated clock stands still.
  const ros::Time now = bus_.now();
  if (now.toSec() == tip_stamp_) return;
  tf2_msgs::TFMessage message;
  message.transforms.push_back(enlarged("needle_tip", tip, enlargement_, now));
  tf_.publish(message);
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
