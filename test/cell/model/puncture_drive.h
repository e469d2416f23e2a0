#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "cell/model/lock_step.h"
#include "cell/model/puncturable_cell.h"
#include "cell/model/spring_cell.h"

namespace microinjection {

constexpr double kRadius = 28e-6, kTop = kRadius, kStiffness = 0.1;  // m, m, N/m
constexpr double kFriction = 0.05e-6;                                // N

inline Scene sceneOf(const PunctureConfig& puncture) {
  Scene scene;
  scene.cell.puncture = puncture;
  return scene;
}

/// Zona at 1 uN, that is 10 um deep; oolemma 2 um further of 0.02 N/m, at 0.2 uN, that is after 10 um more.
inline PunctureConfig oocyte() {
  PunctureConfig config = PunctureConfig::atForce(1e-6);
  PunctureConfig::Layer& oolemma = config.layers.emplace_back();
  oolemma.name = "oolemma";
  oolemma.force = 0.2e-6;
  oolemma.stiffness = 0.02;
  oolemma.gap = 2e-6;
  config.shaft.friction = kFriction;
  return config;
}

/// A needle that is driven into a puncturable spring.
class PunctureDrive {
 public:
  explicit PunctureDrive(const PunctureConfig& puncture, double rate = 1000, std::optional<PiercedBranch> branch = {},
                         std::optional<double> pierced_error = {}, std::optional<PronyTerm> prony = {})
      : step_(1 / rate) {
    auto inner = std::make_unique<SpringCell>(kRadius, kStiffness);
    spring = inner.get();
    Scene scene = sceneOf(puncture);
    if (prony) scene.cell.material().viscoelasticity.prony = {*prony};
    cell = std::make_unique<PuncturableCell>(scene, std::move(inner), std::nullopt, std::move(branch), pierced_error);
  }

  /// On a straight line at `speed`, m/s; returns the force's z at the end, N.
  double moveTo(const Eigen::Vector3d& goal, double speed = 20e-6) {
    const int steps = std::max(1, static_cast<int>(std::lround((goal - tip).norm() / (speed * step_))));
    const Eigen::Vector3d start = tip;
    for (int i = 1; i <= steps; ++i) {
      const Eigen::Vector3d last = tip;
      const Eigen::Vector3d last_force = force;
      tip = start + (goal - start) * i / steps;
      time += step_;
      force = cell->step(tip, kAxis, time).force;
      work -= 0.5 * (last_force + force).dot(tip - last);
      least_work = std::min(least_work, work);
      largest = std::max(largest, force.z());
      smallest = std::min(smallest, force.z());
    }
    return force.z();
  }
  double toDepth(double depth, double speed = 20e-6) { return moveTo({tip.x(), tip.y(), kTop - depth}, speed); }
  double rest(double duration) {
    for (int i = 0; i < std::lround(duration / step_); ++i) {
      time += step_;
      force = cell->step(tip, kAxis, time).force;
    }
    return force.z();
  }
  double holeLength() const {  ///< m, of a hole by mechanics: the spring is drawn with the dent before it
    return cell->insertion().depth - (spring->contact() ? spring->contact()->indentation : 0);
  }
  int layers() const { return cell->insertion().layers_punctured; }

  std::unique_ptr<PuncturableCell> cell;
  SpringCell* spring;
  Eigen::Vector3d tip{0, 0, kTop + 5e-6};
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double time = 0;
  double work = 0, least_work = 0;   ///< J, of the needle on the cell
  double largest = 0, smallest = 0;  ///< N along the pipette

 private:
  double step_;
};

}  // namespace microinjection
