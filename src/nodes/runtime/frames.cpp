#include "nodes/runtime/frames.h"

#include <ros/console.h>

#include <tf2/exceptions.h>

#include <algorithm>
#include <sstream>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {

FrameListener::FrameListener(Bus& bus)
    : bus_(bus),
      moving_(subscribeGuarded<tf2_msgs::TFMessage>(
          bus, "/tf", 100,
          [this](const tf2_msgs::TFMessage& message, const std::string& sender) { receive(message, sender, false); })),
      static_(subscribeGuarded<tf2_msgs::TFMessage>(
          bus, "/tf_static", 100,
          [this](const tf2_msgs::TFMessage& message, const std::string& sender) { receive(message, sender, true); })) {}

void FrameListener::receive(const tf2_msgs::TFMessage& message, const std::string& sender, bool is_static) {
  const ros::Time now = bus_.now();
  if (now < newest_) buffer_.clear();  // the clock was set back
  newest_ = now;
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string topic = is_static ? "/tf_static" : "/tf";
    if (!isTimely(bus_.refusals(), topic, transform, now)) continue;
    if (!isWithin(toVector(transform.transform.translation), kLargestTranslation)) {
      bus_.refusals().add(topic, transform.child_frame_id + " cannot be that far away");
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

Eigen::Isometry3d waitForFrame(Bus& bus, const std::string& parent, const std::string& frame, double timeout) {
  constexpr double kSilent = 5;  // s; a computer that starts a session may be busy
  const FrameListener listener(bus);
  const auto found = [&] { return listener.find(parent, frame).has_value(); };
  const auto missing = [&](double since) {
    std::ostringstream message;
    message << "tf has had no transform from frame '" << frame << "' to '" << parent << "' for " << since
            << " s: rig_frames, robot_state_publisher or a static_transform_publisher must publish it";
    return message.str();
  };
  if (!bus.waitUntil(found, std::min(kSilent, timeout)) && timeout > kSilent && bus.isRunning()) {
    ROS_WARN_STREAM(missing(kSilent));
    bus.waitUntil(found, timeout - kSilent);
  }
  if (const auto pose = listener.find(parent, frame)) return *pose;
  throw ConfigError(missing(timeout));
}

}  // namespace microinjection
