#include "nodes/haptic/force_receiver.h"

#include <ros/publication.h>
#include <ros/topic_manager.h>

namespace microinjection {
namespace {

const ros::WallDuration kPeriod(0.05);
const ros::WallDuration kConnecting(2);  // until all nodes of a session are connected

}  // namespace

bool isSubscribed(const ros::Publisher& publisher, const std::string& node) {
  const auto publication = ros::TopicManager::instance()->lookupPublication(publisher.getTopic());
  if (!publication) return false;
  XmlRpc::XmlRpcValue links;  // as getBusInfo tells them: id, the subscriber's name, ...
  links.setSize(0);
  publication->getInfo(links);
  for (int i = 0; i < links.size(); ++i) {
    if (static_cast<std::string>(links[i][1]) == node) return true;
  }
  return false;
}

bool ForceReceiver::feels() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!asked_ || driver_.empty()) return true;
  if (driver_ == looked_at_ && now - looked_ < kPeriod) return reason_.empty();
  const bool felt = isSubscribed(force_, driver_);
  if (felt || driver_ != looked_at_) felt_ = now;
  looked_at_ = driver_;
  looked_ = now;
  reason_ = felt ? "" : driver_ + " does not subscribe to the hand's force, " + force_.getTopic();
  if (now - felt_ > kConnecting) {
    ROS_WARN_STREAM_THROTTLE(10, reason_ << ": the hand would feel nothing, and the needle does not follow it");
  }
  return felt;
}

}  // namespace microinjection
