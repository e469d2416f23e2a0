#pragma once

#include <cell_microinjection/FindTouchAction.h>
#include <cell_microinjection/VisionState.h>
#include <geometry_msgs/WrenchStamped.h>

#include <memory>
#include <optional>
#include <string>

#include "nodes/bus/goal_node.h"
#include "nodes/imaging/hand_setpoints.h"
#include "nodes/imaging/tip_watch.h"
#include "nodes/runtime/receipt.h"
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
class TouchNode : public GoalNode<cell_microinjection::FindTouchAction> {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  explicit TouchNode(Bus& bus);

 private:
  struct Parameters {
    double input_timeout = 0.5;  ///< s
    double force_timeout = 0.1;  ///< s
    TouchSearchConfig search;

    static Parameters read(const Bus& bus);
  };

  void begin(const Goal& goal) override;
  Result end(bool success) override;
  void step() override;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  void onVision(const cell_microinjection::VisionState& message);
  void onForce(const geometry_msgs::WrenchStamped& message);
  Receipt receive(const ros::Time& stamp) const { return {stamp, bus_.steady()}; }
  bool isOld(const Receipt& receipt, double timeout) const { return receipt.isOld(timeout, bus_.now(), bus_.steady()); }
  TouchSearch::Input input() const;

  Parameters parameters_;
  TipWatch watch_;
  HandSetpoints setpoints_;
  double travel_ = 0;  ///< m, largest one of the goal
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  std::unique_ptr<TouchSearch> search_;  ///< null: the controller has not engaged yet
  std::optional<TouchSearch::Observation> observation_;
  Receipt observation_receipt_;
  std::string image_problem_ = "no image was received";
  std::optional<double> force_;  ///< N along the needle
  double force_stamp_ = 0;       ///< s
  Receipt force_receipt_;
  Subscription vision_, forces_;
};

}  // namespace microinjection
