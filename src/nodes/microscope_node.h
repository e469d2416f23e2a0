#pragma once

#include <cell_microinjection/BoreState.h>
#include <cell_microinjection/CellHold.h>
#include <cell_microinjection/CellState.h>
#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <string>

#include "nodes/bus/diagnostics.h"
#include "nodes/imaging/image_output.h"
#include "nodes/runtime/frames.h"
#include "nodes/runtime/receipt.h"
#include "vision/microscope/focus_axis.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/specimen.h"

namespace microinjection {

/// The virtual microscope: renders the session's scene as a microscope's camera sees it.
///
/// In:  /cell/state, /needle/measured_cp or /needle/true_cp, tf of cell and holding_pipette in world,
///      /focus/move_jp (JointState, position[0]: m, the world's y of the plane in focus), /cell/bore (BoreState: what
///      the needle has drawn in), /cell/hold (CellHold: what the holding pipette has, and where the cell is)
/// Out: microscope/image_raw, microscope/camera_info, /focus/measured_js
///
/// Parameters: config/microscope.yaml
///
/// It keeps its rate in steady time, as a camera does. While /cell/state is stale or not finite it publishes no
/// image: a picture of the past must not look like a new one. Bores whose state is silent or stale are empty.
class MicroscopeNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range.
  explicit MicroscopeNode(Bus& bus);

 private:
  struct Parameters {
    double rate = 30;  ///< Hz of steady time
    std::string needle = "measured";
    double state_timeout = 0.5;  ///< s of steady time, of /cell/state
    FocusAxisConfig focus;
    SpecimenConfig specimen;
    MicroscopeConfig microscope;

    static Parameters read(const Bus& bus);
  };

  void onState(const cell_microinjection::CellState& message);
  void onNeedle(const geometry_msgs::PoseStamped& message);
  void onBore(const cell_microinjection::BoreState& message);
  void onHold(const cell_microinjection::CellHold& message);
  void onFocus(const sensor_msgs::JointState& message);
  bool isFresh(const Receipt& receipt) const;
  bool needleIsFresh() const;
  Specimen specimen() const;         ///< as it is now, in the world; @pre missingInput() is empty
  std::string missingInput() const;  ///< why there is no image; empty when there is one
  void step();
  void publishFocus(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Bus& bus_;
  Parameters parameters_;
  Microscope microscope_;
  FocusAxis focus_;
  FrameListener frames_;
  ImageOutput images_;
  Specimen specimen_;       ///< vertices in cell_frame_
  std::string cell_frame_;  ///< of the last state
  std::string defect_;      ///< of the last state; empty: it can be drawn
  ros::SteadyTime received_, stepped_, reported_;
  Receipt needle_receipt_, bore_receipt_, hold_receipt_;
  Eigen::Isometry3d moved_ = Eigen::Isometry3d::Identity();  ///< the cell, from its place at the start
  bool punctured_ = false;                                   ///< of the last state: a layer has failed
  std::uint64_t frame_ = 0;                                  ///< number of images, which seeds their noise
  unsigned rendered_ = 0;                                    ///< since reported_
  double longest_render_ = 0;                                ///< s, since reported_

  Publisher<sensor_msgs::JointState> focus_state_;
  Subscription state_, needle_, bore_, hold_, focus_command_;
  Diagnostics diagnostics_;
  BusHandle timer_;
};

}  // namespace microinjection
