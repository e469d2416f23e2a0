#include "nodes/runtime/frames.h"

#include <tf2/exceptions.h>

#include <sstream>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {

FrameListener::FrameListener(ros::NodeHandle node)
    : moving_(subscribeGuarded<tf2_msgs::TFMessage>(
          node, "/tf", 100,
          [this](const tf2_msgs::TFMessage& message, const std::string& sender) { receive(message, sender, false); })),
      static_(subscribeGuarded<tf2_msgs::TFMessage>(
          node, "/tf_static", 100,
          [this](const tf2_msgs::TFMessage& message, const std::string& sender) { receive(message, sender, true); })) {}

void FrameListener::receive(const tf2_msgs::TFMessage& message, const std::string& sender, bool is_static) {
  const ros::Time now = ros::Time::now();
  if (now < newest_) buffer_.clear();  // the clock was set back
  newest_ = now;
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string topic = is_static ? "/tf_static" : "/tf";
    if (!isTimely(topic, transform, now)) continue;
    if (!isWithin(toVector(transform.transform.translation), kLargestTranslation)) {
      MessageRefusals::ofProcess().add(topic, transform.child_frame_id + " cannot be that far away");
      continue;
    }
    buffer_.setTransform(transform, sender, is_static);
  }
}

std::optional<Eigen::Isometry3d> FrameListener::find(const std::string& parent, const std::string& frame) const {
  try {
    const auto transform = buffer_.lookupTransform(parent, frame, ros::Time(0)).transform;
    const auto& q = transform.rotation;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    pose.translation() = toVector(transform.translation);
    return pose;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

Eigen::Isometry3d waitForFrame(const std::string& parent, const std::string& frame, double timeout) {
  ros::CallbackQueue queue;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  const FrameListener listener(node);
  const ros::SteadyTime began = ros::SteadyTime::now();
  while (ros::ok() && secondsBetween(began, ros::SteadyTime::now()) <= timeout) {
    queue.callAvailable(ros::WallDuration(0.01));
    if (const auto pose = listener.find(parent, frame)) return *pose;
  }
  std::ostringstream message;
  message << "tf has had no transform from frame '" << frame << "' to '" << parent << "' for " << timeout
          << " s: a static_transform_publisher, as in the node's launch file, or robot_state_publisher must publish it";
  throw ConfigError(message.str());
}

}  // namespace microinjection
