#pragma once

#include <cell_microinjection/CellEstimate.h>
#include <cell_microinjection/CellParameters.h>
#include <cell_microinjection/CellState.h>
#include <cell_microinjection/InjectionStatus.h>
#include <cell_microinjection/PunctureScore.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/cell_follower.h"
#include "cell/estimation/image_contact.h"
#include "cell/estimation/indentation_course.h"
#include "cell/estimation/puncture_prediction.h"
#include "cell/family/family_cell.h"
#include "nodes/bus/bus.h"
#include "nodes/cell/dimple_reader.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// config/cell_estimator.yaml, and what a session sets.
struct CellEstimatorParameters {
  std::string scene, families;
  double rate = 1000;
  double update_period = 0.02;
  double needle_timeout = 0.05, force_timeout = 0.05, controller_timeout = 0.5;
  double largest_tilt = 0.035;
  double largest_speed = 60e-6;
  double largest_force = 450e-6;
  double largest_sideways = 3e-6;
  double clear_distance = 5e-6;
  bool serve = true;
  CellFollowerConfig served;
  double puncture_deviation = 0.2;
  CellEstimatorConfig estimator;
  bool images = true;  ///< dimples in images are learned from
  ImageContactConfig image;

  /// @throws ConfigError
  static CellEstimatorParameters read(const Bus& bus);
};

/// The cell estimator: finds modulus and height of the cell that the needle indents, see
/// CellEstimator, and has cell_simulator serve them.
///
/// In:  /needle/measured_cp, /force_sensor/measured_cf, /controller/injection_state, /cell/state
///      (the sizes of the served cell), /vision/state (the dimple under the needle)
/// Out: /cell/estimate (CellEstimate), /cell/set_parameters (CellParameters), /cell/puncture_score
///      (PunctureScore)
///
/// Parameters: config/cell_estimator.yaml
class CellEstimatorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError, also when no family contains the scene's cell
  explicit CellEstimatorNode(Bus& bus);

 private:
  void take(const Scene& scene, FamilyCell member);
  void onCell(const cell_microinjection::CellState& message);
  void step(const Cycle::Tick& tick);
  void followForce(const geometry_msgs::WrenchStamped& message);
  /// Learns from the newest reading. Returns why not; empty if it did.
  std::string learn(const ros::Time& now);
  void followIndentation(const Eigen::Vector3d& tip, const ros::Time& now);
  void followSpeed(const Eigen::Vector3d& tip, const ros::Time& now);
  std::string interruption(const ros::Time& now) const;
  void serve(const ros::Time& now);
  void predict();
  void score(const ros::Time& now);
  void publish(const ros::Time& now, double update_time);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  CellEstimatorParameters parameters_;
  Scene scene_;                                              ///< the prior
  std::vector<std::shared_ptr<const FamilyData>> families_;  ///< of the rivals
  FamilyCell member_;
  std::unique_ptr<CellEstimator> estimator_;
  std::unique_ptr<PuncturePredictor> predictor_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& needle_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Input<cell_microinjection::InjectionStatus>& controller_;
  Output<cell_microinjection::CellEstimate>& estimate_;
  Output<cell_microinjection::CellParameters>& change_;
  Output<cell_microinjection::PunctureScore>& score_;
  Subscription cell_;
  std::string held_;
  std::string foreign_;                 ///< why the served cell is none of the family; empty: it is one
  std::vector<double> foreign_values_;  ///< its parameters
  IndentationCourse indentation_;
  std::unique_ptr<DimpleReader> dimples_;  ///< null: images are not learned from
  std::optional<PuncturePrediction> expected_;
  CellFollower served_;
  bool other_cell_ = false;  ///< is served, at the height of the one before
  bool is_scored_ = true;    ///< the last puncture
  ros::Time punctured_at_, last_step_, last_force_, updated_, marked_;
  Eigen::Vector3d mark_ = Eigen::Vector3d::Zero();             ///< m, of the tip at marked_
  double speed_ = 0;                                           ///< m/s
  Eigen::Matrix3d orientation_ = Eigen::Matrix3d::Identity();  ///< of the needle in the world, the last valid one
};

}  // namespace microinjection
