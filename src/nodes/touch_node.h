#pragma once

#include <actionlib/server/simple_action_server.h>
#include <cell_microinjection/FindTouchAction.h>
#include <cell_microinjection/VisionState.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <memory>
#include <optional>
#include <string>

#include "nodes/imaging/arrival.h"
#include "nodes/imaging/tip_watch.h"
#include "nodes/runtime/master_monitor.h"
#include "vision/measurement/touch_search.h"

namespace microinjection {

/// Lowers the needle until the image shows that it touches the cell. It takes the hand's place, as
/// visual_servo does: its set-points go through the controller, whose limits and guards hold.
///
/// In:  vision/state, /needle/measured_cp, /controller/operating_state, /force_sensor/measured_cf
/// Out: /teleop/servo_cp while a goal is active; the action touch/find (FindTouch)
///
/// Parameters: config/touch.yaml
///
/// The set-points end at the touch and with every failure. The controller then holds the needle.
class TouchNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  TouchNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    double input_timeout = 0.5;  ///< s
    double force_timeout = 0.1;  ///< s
    TouchSearchConfig search;
  };
  static Parameters readParameters(const ros::NodeHandle& private_node);

  void onGoal();
  void begin(double travel);  ///< throws ConfigError with the reason for a refusal
  void onVision(const cell_microinjection::VisionState& message);
  void onForce(const geometry_msgs::WrenchStamped& message);
  bool isEngaged();
  TouchSearch::Input input() const;
  void step();
  void finish(bool success, std::string message);

  Parameters parameters_;
  ros::NodeHandle node_;
  TipWatch watch_;
  bool active_ = false;
  double travel_ = 0;  ///< m, largest one of the goal
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  ros::SteadyTime accepted_, began_;     ///< of the goal, and of the connection to the controller
  std::unique_ptr<TouchSearch> search_;  ///< null: the controller has not engaged yet
  std::optional<TouchSearch::Sight> sight_;
  Arrival sight_arrival_;
  std::string blind_ = "no image was received";
  std::optional<double> force_;  ///< N along the needle
  double force_stamp_ = 0;       ///< s
  Arrival force_arrival_;
  std::string outcome_ = "no goal yet";
  ros::Publisher setpoints_;  ///< while a goal is active, so that a hand finds the topic free
  ros::Subscriber others_;    ///< counts the publishers of the set-points
  ros::Subscriber vision_, forces_;
  MasterMonitor master_{true};
  actionlib::SimpleActionServer<cell_microinjection::FindTouchAction> action_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
};

}  // namespace microinjection
