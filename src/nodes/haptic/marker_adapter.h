#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <utility>
#include <vector>

#include "nodes/haptic/haptic_adapter.h"
#include "nodes/haptic/marker_server.h"
#include "nodes/haptic/session_state.h"
#include "operation/display/display_scale.h"
#include "operation/teleoperation/goal_hand.h"

namespace microinjection {

struct MarkerConfig {
  GoalHandConfig hand;
  double hand_scale = 1e3;                        ///< m of the hand per m of the marker in `world`
  Eigen::Vector3d handle_offset = {36e-6, 0, 0};  ///< m, from the tip to the handle, `world`
  double arrow_scale = 20e-6;                     ///< m/N, length of the force's arrow, before the enlargement
  double enlargement = kDisplayScale;             ///< m in rviz per m, as of the display

  static MarkerConfig read(ConfigReader& reader);
};

/// A handle beside the needle in rviz, which the operator drags with the mouse, and a menu of
/// commands. While the mouse button is down, the operator is present and the needle follows the
/// handle; otherwise the handle returns to the needle. While the bridge holds the needle or the
/// controller is not ENABLED, the hand waits, so that needle and handle stay together. After a long
/// hold, or when rviz was stale, the needle rests until the next drag. Motion that a guard of the
/// controller refuses is lost: it separates handle and needle.
///
/// The handle lies in viz/world, at x 1e4. Its topics are /hand_marker/... and not below viz/,
/// which no node that controls may read.
class MarkerAdapter : public HapticAdapter {
 public:
  using Config = MarkerConfig;
  MarkerAdapter(Cycle& cycle, const MarkerConfig& config);

  std::optional<HandReading> read(const Cycle::Tick& tick) override;
  void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) override;
  std::vector<std::string> takeCommands() override { return std::exchange(commands_, {}); }

 private:
  using Feedback = MarkerServer::Feedback;
  void onFeedback(const Feedback& feedback);
  void beginDrag();
  void endDrag();
  void moveHand(const Cycle::Tick& tick);
  std::string reasonText() const;
  void followNeedle();
  void displayForce(const Eigen::Vector3d& force);

  MarkerConfig config_;
  GoalHand hand_;
  SessionState session_;
  Input<geometry_msgs::PoseStamped>&needle_, &target_;
  MarkerServer server_;
  Subscription controller_;
  Publisher<visualization_msgs::MarkerArray> force_;
  std::vector<std::string> commands_;
  std::optional<Eigen::Vector3d> tip_;                   ///< m, `world`
  Eigen::Vector3d handle_ = Eigen::Vector3d::Zero();     ///< m, `world`, as shown
  Eigen::Vector3d drag_from_ = Eigen::Vector3d::Zero();  ///< m, `world`, of the handle
  Eigen::Vector3d hand_from_ = Eigen::Vector3d::Zero();  ///< m, of the hand
  bool dragged_ = false;
  bool was_controlling_ = false;  ///< in this drag
  double held_ = 0;               ///< s, since the hand controlled the needle or the drag began
  std::string lost_reason_;       ///< why a drag ended while the mouse button was down; else empty
  std::string controller_state_;  ///< empty: it follows, or nothing is received
  ros::Time shown_;
};

}  // namespace microinjection
