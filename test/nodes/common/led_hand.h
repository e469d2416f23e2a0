#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>

#include "cell_microinjection/CellState.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {

/// The test is the hand: it publishes the hand's position in each step, and takes the force.
class LedHand {
 public:
  explicit LedHand(VirtualSession& session) : session_(session) {
    TestNode& world = session.world();
    world.hear<geometry_msgs::WrenchStamped>("haptic/servo_cf");
    world.hear<geometry_msgs::PoseStamped>("needle/measured_cp");
    world.repeat<geometry_msgs::PoseStamped>("haptic/measured_cp", [this] { return position(); });
  }

  /// Straight to z (m) at `speed` (m/s), then `rest` (s).
  void moveTo(double goal, double speed = 0.1, double rest = 0.15) {
    const double start = z, duration = std::abs(goal - start) / speed;
    const int steps = std::max(1, static_cast<int>(std::lround(1e3 * duration)));
    for (int i = 1; i <= steps; ++i) {
      z = start + (goal - start) * i / steps;
      session_.run(1e-3);
    }
    session_.run(rest);
  }
  void clutch(bool pressed) { session_.world().sayNow("haptic/clutch", joyMessage({pressed ? 1 : 0})); }

  Eigen::Vector3d force() {
    const auto* message = session_.world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf").newest();
    return message ? toVector(message->wrench.force) : Eigen::Vector3d::Constant(NAN);
  }
  Eigen::Vector3d needle() {
    const auto* message = session_.world().hear<geometry_msgs::PoseStamped>("needle/measured_cp").newest();
    return message ? toVector(message->pose.position) : Eigen::Vector3d::Constant(NAN);
  }

  double z = 0;                                       ///< m
  bool silent = false;                                ///< publishes nothing
  std::optional<geometry_msgs::PoseStamped> instead;  ///< publishes this

 private:
  std::optional<geometry_msgs::PoseStamped> position() const {
    if (silent) return std::nullopt;
    return instead ? *instead : poseMessage(0, 0, z, "haptic");
  }

  VirtualSession& session_;
};

}  // namespace microinjection
