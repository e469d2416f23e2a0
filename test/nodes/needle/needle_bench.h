#pragma once

#include <geometry_msgs/TwistStamped.h>

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>

#include "cell_microinjection/ManipulatorAbilities.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/stamps.h"
#include "virtual_session.h"

namespace microinjection {

constexpr char kNeedleStatus[] = "micromanipulator: commands", kNeedleInputs[] = "micromanipulator: inputs";

inline geometry_msgs::PoseStamped poseAt(const Eigen::Vector3d& place, const std::string& frame = "world") {
  return poseMessage(place.x(), place.y(), place.z(), frame);
}
inline geometry_msgs::TwistStamped velocityMessage(double x, const std::string& frame = "") {
  geometry_msgs::TwistStamped message;
  message.header.frame_id = frame;
  message.twist.linear.x = x;
  return message;
}

/// The distance of two places along the axis where it is largest; not a number where one of them is none.
inline double farthestAxis(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d distance = (a - b).cwiseAbs();
  return distance.allFinite() ? distance.maxCoeff() : NAN;
}

/// A micromanipulator alone. The test, as the node "world", commands it and hears what it tells.
class NeedleBench {
 public:
  using Abilities = cell_microinjection::ManipulatorAbilities;
  using OperatingState = cell_microinjection::OperatingState;
  using Pose = geometry_msgs::PoseStamped;

  /// `rig`: as in a session's file; `changes`: of the node's parameters.
  explicit NeedleBench(const std::string& rig = "sim", const std::string& changes = "{}")
      : session({"rig.name:=" + rig}),
        world(session.world()),
        poses(world.hear<Pose>("needle/measured_cp")),
        states(world.hear<OperatingState>("needle/operating_state")) {
    YAML::Node parameters = YAML::Load(changes);
    parameters["diagnostic_period"] = 0.1;  // s
    session.add("micromanipulator", YAML::Dump(parameters));
  }

  void run(double seconds) { session.run(seconds); }
  bool until(const std::function<bool()>& done, double limit = 20) { return session.until(done, limit); }

  void move(const Eigen::Vector3d& place) { world.sayNow("needle/move_cp", poseAt(place)); }
  /// In each step from now on, until world.silence().
  void servo(const Pose& pose) { world.repeat<Pose>("needle/servo_cp", pose); }
  void silence() { world.silence("needle/servo_cp"); }
  void command(const std::string& word) { world.command("needle/state_command", word); }
  void inject(const std::string& fault) {
    if (session.stage()) return session.stage()->inject(fault, session.now());
    world.command("needle/emulated_fault", fault);
  }

  /// m; not a number while the rig does not know.
  static Eigen::Vector3d placeOf(const Pose& pose) {
    return pose.header.stamp.isZero() ? Eigen::Vector3d::Constant(NAN) : toVector(pose.pose.position);
  }
  Eigen::Vector3d needle() const { return poses.newest() ? placeOf(*poses.newest()) : Eigen::Vector3d::Constant(NAN); }
  std::string state() const { return states.newest() ? states.newest()->state : ""; }
  bool busy() const { return states.newest() && states.newest()->is_busy; }
  const Abilities& abilities() {
    const Probe<Abilities>& heard = world.hear<Abilities>("needle/abilities");
    if (!heard.newest()) run(0.002);  // they are latched
    if (!heard.newest()) throw std::runtime_error("the rig tells no abilities");
    return *heard.newest();
  }

  /// Runs so long (s). @returns the largest distance (m) of an axis from where it began; not a number where the rig
  /// does not know its place
  double strays(double seconds) {
    const Eigen::Vector3d held = needle();
    const std::size_t first = poses.count();
    run(seconds);
    double farthest = poses.count() > first ? 0 : NAN;
    for (std::size_t i = first; i < poses.count(); ++i) {
      const double distance = farthestAxis(placeOf(*poses.all()[i]), held);
      if (!(distance <= farthest)) farthest = distance;
    }
    return farthest;
  }

  std::string status() const { return session.diagnostics().text(kNeedleStatus); }
  int level() const {
    const auto* status = session.diagnostics().of(kNeedleStatus);
    return status ? status->level : -1;
  }
  int refused() const {
    const std::string count = session.diagnostics().value(kNeedleStatus, "commands refused");
    return count.empty() ? 0 : std::stoi(count);
  }

  VirtualSession session;
  TestNode& world;
  Probe<Pose>& poses;
  Probe<OperatingState>& states;
};

inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

/// m, each axis.
inline ::testing::AssertionResult isNear(const Eigen::Vector3d& place, const Eigen::Vector3d& wanted,
                                         double tolerance) {
  if (farthestAxis(place, wanted) <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "[" << place.transpose() << "] m is not within " << tolerance << " m of ["
                                       << wanted.transpose() << "]";
}

}  // namespace microinjection
