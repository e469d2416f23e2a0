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
  XmlRpc::XmlRpcValue links;  // as in getBusInfo: id, the subscriber's name, ...
  links.setSize(0);
  publication->getInfo(links);
  for (int i = 0; i < links.size(); ++i) {
    if (static_cast<std::string>(links[i][1]) == node) return true;
  }
  return false;
}

bool ForceReceiver::isConnected() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!required_ || driver_.empty()) return true;
  if (driver_ == checked_driver_ && now - checked_ < kPeriod) return reason_.empty();
  const bool connected = isSubscribed(force_, driver_);
  if (connected || driver_ != checked_driver_) connected_ = now;
  checked_driver_ = driver_;
  checked_ = now;
  reason_ = connected ? "" : driver_ + " does not subscribe to the hand's force, " + force_.getTopic();
  if (now - connected_ > kConnecting) {
    ROS_WARN_STREAM_THROTTLE(10, reason_ << ": without the force the needle does not follow the hand");
  }
  return connected;
}

}  // namespace microinjection
