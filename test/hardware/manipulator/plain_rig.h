#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/simulated_manipulator.h"

namespace microinjection {

constexpr double kStep = 1e-3;  // s

/// Three axes along those of the world, from -1 to 1 mm.
inline ManipulatorGeometry geometry() {
  ManipulatorGeometry rig;
  for (auto& axis : rig.axes) axis = {"axis", -1e-3, 1e-3, 2e-3, 0.05};
  rig.directions.setIdentity();
  rig.tip_at_zero.setIdentity();
  return rig;
}

inline Eigen::Isometry3d at(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << x, y, z;
  return pose;
}

/// A micromanipulator with these axes and nothing in its way, stepped at 1 kHz.
class PlainRigTest : public testing::Test {
 protected:
  void run(double duration) {
    for (long i = std::lround(duration / kStep); i > 0; --i) {
      rig_.step(time_ += kStep, kStep);
      fastest_ = std::max(fastest_, rig_.tipVelocity()->norm());
    }
  }

  SimulatedManipulatorConfig device_config_;
  SimulatedManipulator device_{geometry(), device_config_};
  Micromanipulator rig_{geometry(), CollisionGuard(), MicromanipulatorConfig(), device_};
  double time_ = 0;     // s
  double fastest_ = 0;  // m/s
};

}  // namespace microinjection
