#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/JointState.h>

#include <Eigen/Geometry>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "cell_microinjection/OperatingState.h"
#include "cell_microinjection/StringStamped.h"
#include "hardware/devices/joint_axes.h"
#include "hardware/manipulator/commanded_path.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/manipulator/manipulator_geometry.h"
#include "hardware/manipulator/straight_move.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// config/rigs/external.yaml.
struct ExternalManipulatorConfig {
  std::string name_space = "/my_rig";
  bool joints_told = true;                         ///< positions: joints; otherwise poses
  std::vector<std::string> joints{"x", "y", "z"};  ///< of JointState
  std::string frame = "world";                     ///< of poses
  JointAxes axes;
  double rate = 100;             ///< Hz
  double lag = 0.05;             ///< s
  double timeout = 0.1;          ///< s
  double resolution = 0.1e-6;    ///< m
  double path_tolerance = 2e-6;  ///< m

  static ExternalManipulatorConfig read(ConfigReader& reader);
  bool inWorld() const { return !joints_told && frame == "world"; }
};

/// A micromanipulator that another node moves, by CRTK topics below its namespace. That node is told
/// short steps only, so that it rests within its lag when this one is gone.
///
/// In:  measured_js (JointState) or measured_cp (PoseStamped), operating_state (OperatingState; stamps
///      do not count)
/// Out: servo_jp (JointState) or servo_cp (PoseStamped), at most `rate` times a second;
///      state_command (StringStamped): enable, or resume, when the needle is enabled and the node is not
///
/// Its positions count once they have come at `rate` for 0.5 s. Anew after each message that is not
/// valid (not finite, another frame, other joints, stamp 0), after a pause of `timeout`, and after
/// another publisher's message. It may move while it is ENABLED and homed. The device is disconnected
/// otherwise: no goal is kept, and when it may move again, the first set-point is the needle's place,
/// so that no old set-point is pursued.
///
/// Faults: its own FAULT; a position off the commanded path by more than path_tolerance, which is a lag
/// above `lag` as well as a motion of its own while it is commanded; a position that leaps, or is
/// another one after a pause (the node has another origin); a second node that commands it.
class ExternalManipulator : public ManipulatorDevice {
 public:
  /// `cycle` outlives it.
  ExternalManipulator(Cycle& cycle, const ManipulatorGeometry& geometry, const ExternalManipulatorConfig& config);
  ExternalManipulator(const ExternalManipulator&) = delete;

  ManipulatorAbilities abilities() const override;
  void limitSpeed(const Eigen::Vector3d&) override {}  ///< the set-points are within the geometry's limits
  void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) override;
  void moveTo(const Eigen::Vector3d& joints, double speed) override;
  void stop() override;        ///< the set-point is the needle's place
  void clearFault() override;  ///< also asks the node to enable itself
  void step(double time) override;
  State state() const override;
  std::string reason() const override;
  std::string note() const override;
  std::optional<Reading> reading() const override;
  bool moving() const override;

  /// Rate and lag, as measured and as told.
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  struct Measured {
    ros::Time time;  ///< of the measurement
    Eigen::Vector3d joints;
  };
  struct Goal {
    AxesMotion setpoint;
    std::optional<Eigen::Vector3d> end;  ///< m, of moveTo
    double speed = 0;                    ///< m/s, of moveTo
    ros::Time commanded;
  };

  void subscribe();
  template <typename Message>
  void receive(Input<Message>& input, const Message& message, const ros::Time& now);
  std::string toJoints(const sensor_msgs::JointState& message, Eigen::Vector3d& joints) const;
  std::string toJoints(const geometry_msgs::PoseStamped& message, Eigen::Vector3d& joints);
  bool isElsewhere(const Eigen::Vector3d& joints, double pause) const;
  void take(const Measured& measured);
  void checkPath(const Measured& measured);
  void onState(const cell_microinjection::OperatingState& message, const ros::Time& now);
  template <typename Message>
  Publisher<Message> advertise(const std::string& topic);

  std::string topic(const std::string& name) const { return config_.name_space + "/" + name; }
  ros::Time now() const { return cycle_.bus().now(); }
  std::string positionsReason(const ros::Time& now);
  std::string nodeReason(const ros::Time& now) const;
  void distrust(const std::string& why);
  void raiseFault(const std::string& reason);
  void release();
  void hold();
  void advance(double dt);
  void send(const ros::Time& now);
  double rate(const ros::Time& now) const;
  Eigen::Vector3d velocity() const;

  Cycle& cycle_;
  ManipulatorGeometry geometry_;
  ExternalManipulatorConfig config_;
  InputPort* measured_ = nullptr;  ///< measured_js or measured_cp
  Input<cell_microinjection::OperatingState>& state_input_;
  Subscription rivals_;
  Publisher<sensor_msgs::JointState> joint_commands_;    ///< or
  Publisher<geometry_msgs::PoseStamped> pose_commands_;  ///< of this
  Publisher<cell_microinjection::StringStamped> words_;
  geometry_msgs::Quaternion orientation_;  ///< of the last pose

  std::deque<Measured> readings_;  ///< of the last kWindow, all valid
  std::optional<Measured> last_;   ///< valid one, ever
  ros::Time since_;                ///< from which all were valid; zero: the last was not
  bool trusted_ = false;           ///< valid for long enough, and often enough
  bool displaced_ = false;         ///< by a leap: not valid until clearFault
  bool repeats_ = false;           ///< the last message had no new stamp
  double age_ = 0;                 ///< s, of the last one at its arrival
  std::string distrust_;           ///< why the last message was not valid; empty: it was
  std::string before_;             ///< the last such reason

  cell_microinjection::OperatingState node_;  ///< of the node; no text: not told yet
  ros::Time asked_;                           ///< to enable itself
  bool ready_ = false;
  std::string reason_, fault_;
  std::optional<Goal> goal_;
  ros::Time sent_, stepped_;
  Eigen::Vector3d sent_position_ = Eigen::Vector3d::Zero();  ///< m, the last set-point that was sent
  std::optional<Eigen::Vector3d> coasts_to_;                 ///< m, the last set-point before it was released
  CommandedPath path_;                                       ///< of the tip in world
  double largest_lag_ = 0;                                   ///< s, since the last report
};

}  // namespace microinjection
