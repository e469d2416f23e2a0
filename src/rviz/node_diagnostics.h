#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <functional>
#include <optional>
#include <string>

namespace microinjection {

/// What one node says of itself on /diagnostics, read when the caller asks.
class NodeDiagnostics {
 public:
  using Handler = std::function<void(const diagnostic_msgs::DiagnosticStatus& status)>;

  /// @param name  of the status, as "force_sensor: sensor"
  explicit NodeDiagnostics(std::string name, Handler handler = {});
  /// Subscribes: a box that is not shown has no use for the messages.
  void start();
  void poll();
  bool started() const { return node_.has_value(); }
  bool isFresh() const;  ///< the node reports each second

 private:
  void read(const diagnostic_msgs::DiagnosticArray& message);

  std::string name_;
  Handler handler_;
  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Subscriber reports_;
  std::optional<double> heard_at_;  ///< s, sessionNow()
};

}  // namespace microinjection
