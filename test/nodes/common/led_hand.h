#pragma once

#include <Eigen/Core>
#include <algorithm>
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
  static constexpr double kScale = 1e-3;     ///< m of the needle per m of the hand, config/haptic_bridge.yaml
  static constexpr double kForceGain = 2e5;  ///< N at the hand per N at the tip
  static constexpr double kGap = 32e-6;      ///< m, from where the needle starts to a cell of 56 um

  explicit LedHand(VirtualSession& session) : session_(session) {
    TestNode& world = session.world();
    world.hear<geometry_msgs::WrenchStamped>("haptic/servo_cf");
    world.hear<geometry_msgs::PoseStamped>("needle/measured_cp");
    world.repeat<geometry_msgs::PoseStamped>("haptic/measured_cp", [this] { return position(); });
  }

  /// Straight to z (m) at `speed` (m/s), then `rest` (s).
  void moveTo(double goal, double speed = 0.1, double rest = 0.15) {
    stroke_.reset();
    const double start = z, duration = std::abs(goal - start) / speed;
    const int steps = std::max(1, static_cast<int>(std::lround(1e3 * duration)));
    for (int i = 1; i <= steps; ++i) {
      const double next = start + (goal - start) * i / steps, force_z = force().z();
      if (std::isfinite(force_z)) energy_ -= force_z * (next - z);
      lowest_energy_ = std::min(lowest_energy_, energy_);
      z = next;
      session_.run(1e-3);
    }
    session_.run(rest);
  }
  /// From now on up and down between here and `way` (m) below, at `speed` (m/s), so that a needle that follows never
  /// rests.
  void sway(double way, double speed) { stroke_ = Stroke{z, z - way, -1e-3 * speed}; }
  /// From z = 0, before a clutch or a hold has changed what belongs together: the needle to `depth` (m) in the cell.
  void press(double depth, double speed = 0.1, double rest = 0.15) { moveTo(-(kGap + depth) / kScale, speed, rest); }
  void clutch(bool pressed) { session_.world().sayNow("haptic/clutch", joyMessage({pressed ? 1 : 0})); }

  Eigen::Vector3d force() {
    const auto* message = session_.world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf").newest();
    return message ? toVector(message->wrench.force) : Eigen::Vector3d::Constant(NAN);
  }
  Eigen::Vector3d needle() {
    const auto* message = session_.world().hear<geometry_msgs::PoseStamped>("needle/measured_cp").newest();
    return message ? toVector(message->pose.position) : Eigen::Vector3d::Constant(NAN);
  }

  /// What the hand has put into the device while it moved, and the least of it (J).
  double energy() const { return energy_; }
  double lowestEnergy() const { return lowest_energy_; }

  double z = 0;                                       ///< m
  bool silent = false;                                ///< publishes nothing
  std::optional<geometry_msgs::PoseStamped> instead;  ///< publishes this

 private:
  struct Stroke {
    double high, low;  ///< m
    double step;       ///< m, each millisecond
  };

  std::optional<geometry_msgs::PoseStamped> position() {
    if (stroke_) {
      z += stroke_->step;
      if (z <= stroke_->low) stroke_->step = std::abs(stroke_->step);
      if (z >= stroke_->high) stroke_->step = -std::abs(stroke_->step);
    }
    if (silent) return std::nullopt;
    return instead ? *instead : poseMessage(0, 0, z, "haptic");
  }

  VirtualSession& session_;
  std::optional<Stroke> stroke_;
  double energy_ = 0, lowest_energy_ = 0;  ///< J
};

}  // namespace microinjection
