#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Core>
#include <optional>

#include "base/config_reader.h"
#include "cell_microinjection/InjectionStatus.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/force_liveness.h"
#include "operation/teleoperation/force_source.h"

namespace microinjection {

/// s, past which an input from the rig is stale.
struct PeerTimeouts {
  double needle = 0.05;
  double predicted = 0.05;
  double measured = 0.05;
  double controller = 0.25;  ///< 0: not checked, with another controller

  /// Keys of `timeouts`.
  void read(ConfigReader& timeouts);
};

/// Needle, force and controller, as teleoperation needs them.
///
/// In: /needle/measured_cp (PoseStamped), /cell/predicted_cf, /force_sensor/measured_cf or both
///     (WrenchStamped), /controller/injection_state (InjectionStatus, to detect the controller)
class PeerInputs {
 public:
  /// `quiet_sensor`: of the session, sensor/quiet.
  PeerInputs(Cycle& cycle, const PeerTimeouts& timeouts, const ForceSourceConfig& source, bool quiet_sensor);

  struct Reading {
    bool controller = true;                 ///< it publishes, or is not checked
    std::optional<Eigen::Vector3d> needle;  ///< m, the tip in `world`; empty: invalid or stale
    TipForces force;                        ///< empty without a needle
  };
  Reading read(const ros::Time& now);
  /// Stamp of the force that Reading has; of the predicted one where both are used. @pre it has one
  ros::Time forceStamp(const ros::Time& now) const;

 private:
  Input<geometry_msgs::PoseStamped>& needle_;
  Input<geometry_msgs::WrenchStamped>* predicted_ = nullptr;           ///< null: not used
  Input<geometry_msgs::WrenchStamped>* measured_ = nullptr;            ///< null: not used
  Input<cell_microinjection::InjectionStatus>* controller_ = nullptr;  ///< null: not checked
  std::optional<ForceLiveness> predicted_lives_, measured_lives_;
};

}  // namespace microinjection
