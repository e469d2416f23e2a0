#include "nodes/force_watchdog_node.h"

#include "nodes/conversions.h"
#include "nodes/node_parameters.h"

namespace microinjection {

const char* const ForceWatchdogNode::kHelp =
    "force_watchdog: says zero force to a haptic device that speaks CRTK while nobody else says any.\n"
    "In and out: /haptic/servo_cf.\n"
    "Parameters: ~timeout (s), ~rate (Hz).\n";

ForceWatchdogNode::Parameters ForceWatchdogNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("timeout", parameters.timeout, Range::positive());
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.finish();
  return parameters;
}

ForceWatchdogNode::ForceWatchdogNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
    : parameters_(Parameters::read(private_node)),
      force_(node.advertise<geometry_msgs::WrenchStamped>("haptic/servo_cf", 10)),
      subscriber_(node.subscribe<geometry_msgs::WrenchStamped, const Event&>(
          "haptic/servo_cf", 100, [this](const Event& event) { hear(event); }, {},
          ros::TransportHints().tcpNoDelay())) {}

void ForceWatchdogNode::hear(const Event& event) {
  if (event.getPublisherName() == ros::this_node::getName()) return;
  heard_ = ros::Time::now();
  frame_ = event.getConstMessage()->header.frame_id;
}

void ForceWatchdogNode::run() {
  // Wakes up by the wall's time: it must also do so when nothing else does.
  for (ros::WallRate rate(parameters_.rate); ros::ok(); rate.sleep()) {
    ros::spinOnce();
    const ros::Time now = ros::Time::now();
    if ((now - heard_).toSec() < parameters_.timeout) continue;
    force_.publish(toWrench(Eigen::Vector3d::Zero(), now, frame_));
  }
}

}  // namespace microinjection
