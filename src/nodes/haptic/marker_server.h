#pragma once

#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerInit.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"

namespace microinjection {

/// One interactive marker for rviz, with the protocol of interactive_markers::InteractiveMarkerServer,
/// which would make its own connections to ROS. The destructor removes the marker.
///
/// In:  TOPIC/feedback (InteractiveMarkerFeedback)
/// Out: TOPIC/update (InteractiveMarkerUpdate), TOPIC/update_full (InteractiveMarkerInit, latched)
class MarkerServer {
 public:
  using Feedback = visualization_msgs::InteractiveMarkerFeedback;
  using Handler = std::function<void(const Feedback&)>;

  /// `handler` receives what the operator does. An operator who drags also sets the pose.
  MarkerServer(Bus& bus, const std::string& topic, const visualization_msgs::InteractiveMarker& marker,
               Handler handler);
  ~MarkerServer();
  MarkerServer(const MarkerServer&) = delete;
  MarkerServer& operator=(const MarkerServer&) = delete;

  /// Sets the pose in the marker's frame, for the next applyChanges().
  void setPose(const geometry_msgs::Pose& pose);
  /// Publishes the pose if it was set since the last call.
  void applyChanges();

 private:
  using Update = visualization_msgs::InteractiveMarkerUpdate;
  using Init = visualization_msgs::InteractiveMarkerInit;
  void receive(const Feedback& feedback);
  void publish(Update update);
  void publishChange(const Update& update, const std::vector<visualization_msgs::InteractiveMarker>& all);

  Bus& bus_;
  visualization_msgs::InteractiveMarker marker_;
  Handler handler_;
  bool moved_ = false;         ///< its pose was not published
  std::uint64_t changes_ = 0;  ///< published
  std::string client_;         ///< that sent the last accepted feedback
  ros::Time client_heard_;
  Publisher<Init> init_;
  Publisher<Update> update_;
  Subscription feedback_;
  BusHandle keep_alive_;
};

}  // namespace microinjection
