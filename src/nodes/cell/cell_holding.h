#pragma once

#include <geometry_msgs/PoseStamped.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "cell/family/family_tongue.h"
#include "cell/model/scene.h"
#include "cell/pose/cell_hold.h"
#include "cell_microinjection/CellHold.h"
#include "cell_microinjection/HolderState.h"
#include "cell_microinjection/HoldingSeal.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The part of cell_simulator in which suction holds the cell: pressures and poses in, where the cell is out.
///
/// A pressure that is no longer told is that of before: the holder keeps its own, whatever fails.
///
/// In:  /holder/state (HolderState), of a manipulator of the holding pipette /holder_rig/measured_cp or true_cp
///      (PoseStamped)
/// Out: /cell/hold (CellHold, 100 Hz and on a change of the mode), /cell/seal (HoldingSeal, 100 Hz)
class CellHolding {
 public:
  struct Config {
    bool holder = false;              ///< a holder holds the cell; else it is fixed to the mouth
    std::string holder_rig = "none";  ///< pose of the holding pipette: none (it stands), measured or true
    CellMotionConfig motion;          ///< its radius is not used

    static Config read(ConfigReader& reader);
  };

  /// Why no holder can hold the scene's cell; empty: one can.
  static std::string refusal(const Scene& scene);
  /// `families`: folder, for the tongue's length. @pre refusal(scene) is empty. @throws ConfigError
  CellHolding(Cycle& cycle, const Scene& scene, const Config& config, const std::string& families);

  /// Where the cell is now, m, from its place in the scene. `needle`: empty when its pose is not valid.
  const Eigen::Vector3d& step(const Cycle::Tick& tick, const std::optional<Eigen::Isometry3d>& needle, bool inside);
  /// N, on the needle. Call once after step(), with the force that the model has for the cell there.
  Eigen::Vector3d forceOnNeedle(const Eigen::Vector3d& of_model) { return hold_.forceOnNeedle(of_model); }
  void publish(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  DrawnTongue tongue() const;
  void publishHold(const ros::Time& now, double tongue_length);

  Input<cell_microinjection::HolderState>& holder_;
  Input<geometry_msgs::PoseStamped>* mouth_ = nullptr;  ///< null: it stands
  // Not outputs of the cycle: a limit or a resistance may be infinite.
  Publisher<cell_microinjection::CellHold> state_;
  Publisher<cell_microinjection::HoldingSeal> seal_;
  CellHold hold_;
  CellHold::Input input_;
  std::optional<Eigen::Vector3d> mouth_start_;  ///< m
  std::optional<FamilyTongue> tongue_;
  double radius_, modulus_;   ///< m, Pa
  double tongue_volume_ = 0;  ///< m^3, when it was published
  CellMode published_mode_ = CellMode::kFree;
  ros::Time published_;
};

}  // namespace microinjection
