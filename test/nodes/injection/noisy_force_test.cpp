// A hand that rests, and a sensor whose noise crosses the force limit again and again: who may only withdraw the needle
// must not be what moves it.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

/// N/sqrt(Hz), of the white noise of the sensor along the pipette: in the 5 kHz band of its samples 0.24, 0.5, 0.9
/// and 2.4 times the force limit of 15 uN, rms.
class NoisyForceTest : public testing::TestWithParam<double> {
 protected:
  static std::vector<std::string> overrides() {
    std::ostringstream density;
    density << "overrides.force_sensor.simulated.axial_noise_density:=" << GetParam();
    return {"force.controller:=measured", "display.markers:=false", density.str()};
  }
};

TEST_P(NoisyForceTest, DoesNotPumpTheNeedle) {
  VirtualSession session(overrides());
  const std::string motion = session.folder() / "rest.yaml";
  std::ofstream(motion) << "tremor: {rms: 30.0e-6, seed: 1}\npath: [{phase: rest, duration: 40, z: 0}]\n";
  auto& needle = session.world().hear<geometry_msgs::PoseStamped>("needle/measured_cp");
  session.add("virtual_hand", "{motion: " + motion + "}");
  session.start();
  session.run(1);
  const Eigen::Vector3d start = toVector(needle.newest()->pose.position);
  double furthest = 0;  // m
  for (int i = 0; i < 2000; ++i) {
    session.run(0.02);
    furthest = std::max(furthest, (toVector(needle.newest()->pose.position) - start).norm());
  }
  EXPECT_LT(furthest, 5e-6);
}

INSTANTIATE_TEST_SUITE_P(Densities, NoisyForceTest, testing::Values(0.5e-7, 1e-7, 2e-7, 5e-7), [](const auto& density) {
  return std::to_string(std::lround(1e9 * density.param)) + "nNPerRootHz";
});

}  // namespace
}  // namespace microinjection
