#pragma once

#include <cell_microinjection/CellEstimate.h>
#include <cell_microinjection/CellState.h>
#include <cell_microinjection/DisplayView.h>
#include <cell_microinjection/InjectionStatus.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <string>
#include <vector>

#include "nodes/bus/diagnostics.h"
#include "nodes/display/display_frames.h"
#include "nodes/scene/display_scene.h"
#include "operation/display/tip_trail.h"

namespace microinjection {

/// Shows the scene in rviz, enlarged. For people only: no node that controls reads its topics.
///
/// In:  /cell/state (with the predicted force), /force_sensor/measured_cf, /haptic/measured_cp,
///      /controller/injection_state, /cell/estimate, /visual_servo/proposed_point, viz/set_view (DisplayView), and from
///      tf the frames of the rig with needle_tip, which saves poses at 1 kHz
/// Out: viz/view (DisplayView, latched), viz/markers, viz/still (MarkerArray; the second, for rare changes, is latched:
///      an rviz that draws slowly skips messages of the first), tf of viz/{cell, holding_pipette, manipulator_base,
///      needle_tip} below viz/world
///
/// Parameters: config/display.yaml
///
/// It uses steady time, unlike the nodes that control, so that the frame rate does not depend on a
/// simulated clock. Input that is not finite, invalid (stamp 0) or in an unknown frame is not
/// drawn; the diagnostics count it.
class DisplayNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  explicit DisplayNode(Bus& bus);

 private:
  enum InputId { kState, kMeasured, kHand, kInjection, kEstimate, kProposed, kInputs };
  struct Input {
    Input(const std::string& input_topic, bool is_needed) : topic(input_topic), needed(is_needed) {}
    std::string topic;
    bool needed;               ///< its absence causes a warning
    ros::SteadyTime received;  ///< of the last message, drawn or not; zero: none yet
    unsigned refused = 0;      ///< messages that were not drawn
  };

  void onState(const cell_microinjection::CellState& message);
  void onInjection(const cell_microinjection::InjectionStatus& message);
  void onEstimate(const cell_microinjection::CellEstimate& message);
  void onProposed(const geometry_msgs::PointStamped& message);
  void onHand(const geometry_msgs::PoseStamped& message);
  void onView(const cell_microinjection::DisplayView& message);
  void publishView();
  void onMeasuredForce(const geometry_msgs::WrenchStamped& message);
  template <typename Message>
  void subscribe(InputId input, void (DisplayNode::*handler)(const Message&));
  void findTipTransform();
  void count(InputId input, bool drawn);

  void draw();
  void reportDrawing(diagnostic_updater::DiagnosticStatusWrapper& status);
  void reportInputs(diagnostic_updater::DiagnosticStatusWrapper& status);

  Bus& bus_;
  DisplayConfig config_;  // read-only after construction
  DisplayScene scene_;
  DisplayFrames frames_;
  DisplayedState state_;  ///< the latest input
  TipTrail trail_;
  bool cell_changed_ = false;  ///< since the cell was drawn
  std::array<Input, kInputs> inputs_;

  ros::SteadyTime fixed_drawn_;  ///< last time of the fixed markers; zero: draw them
  ros::SteadyTime reported_;
  unsigned drawings_ = 0;       ///< since reported_
  double longest_drawing_ = 0;  ///< s, since reported_

  Publisher<visualization_msgs::MarkerArray> markers_, fixed_markers_;
  Publisher<cell_microinjection::DisplayView> view_;
  std::vector<Subscription> subscriptions_;
  Diagnostics diagnostics_;
  BusHandle timer_;
};

}  // namespace microinjection
