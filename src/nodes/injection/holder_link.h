#pragma once

#include <sensor_msgs/FluidPressure.h>

#include <optional>

#include "cell_microinjection/CellHold.h"
#include "cell_microinjection/HolderState.h"
#include "cell_microinjection/VisionState.h"
#include "nodes/runtime/cycle.h"
#include "operation/control/holding.h"

namespace microinjection {

/// The controller's connection to the holder. A set-point is a message, which is repeated for a while until the holder
/// has it, and then never more: whoever sets another one later is not overruled.
///
/// In:  /holder/state (HolderState), /cell/hold (CellHold), where a cell is simulated; else /vision/state
/// (VisionState),
///      where an image surely shows whether the cell is at the mouth
/// Out: /holder/set_pressure (sensor_msgs/FluidPressure)
class HolderLink {
 public:
  /// `timeout`: s, past which a state is stale.
  HolderLink(Cycle& cycle, double timeout);

  std::optional<HolderReport> report(const ros::Time& now) const;
  std::optional<HoldReport> cell(const ros::Time& now) const;
  /// Call once a step, after report().
  void command(const std::optional<HolderCommand>& command, const ros::Time& now);

 private:
  Input<cell_microinjection::HolderState>& state_;
  Input<cell_microinjection::CellHold>& hold_;
  Input<cell_microinjection::VisionState>& seen_;
  Output<sensor_msgs::FluidPressure>& pressure_;
  HolderCommand last_;      ///< number 0: none yet
  bool delivered_ = true;   ///< or given up
  ros::Time asked_, sent_;  ///< when it was asked for first, and sent last
};

}  // namespace microinjection
