// The cell simulator has no force for a needle pose that it cannot trust, and says so.

#include <gtest/gtest.h>

#include "cell_microinjection/CellState.h"
#include "nodes/runtime/conversions.h"
#include "scripted_needle.h"

namespace microinjection {
namespace {

struct UntrustedNeedle {
  const char* name;
  void (*publish)(ScriptedNeedle&);
};

class CellSimulatorTrustTest : public testing::TestWithParam<UntrustedNeedle> {
 protected:
  CellSimulatorTrustTest() {
    predicted();
    state();
    session_.add("cell_simulator", "{needle: measured, diagnostic_period: 0.1}");
  }

  const geometry_msgs::WrenchStamped* predicted() {
    return session_.world().hear<geometry_msgs::WrenchStamped>("cell/predicted_cf").newest();
  }
  const cell_microinjection::CellState* state() {
    return session_.world().hear<cell_microinjection::CellState>("cell/state").newest();
  }
  void press() {
    needle_.publish();
    needle_.z = 31e-6;
    needle_.moveTo(25e-6, 20e-6);
    session_.run(0.05);
    EXPECT_GT(predicted()->wrench.force.z, 0.2e-6);
    EXPECT_FALSE(predicted()->header.stamp.isZero());
    EXPECT_TRUE(state()->converged) << state()->reason;
  }

  VirtualSession session_{{"cell:=" + testFile("scenes/coarse_oocyte.yaml"), "model:=live"}};
  ScriptedNeedle needle_{session_, 31e-6};
};

TEST_P(CellSimulatorTrustTest, HasNoForceOfAPoseThatItCannotTrust) {
  press();
  GetParam().publish(needle_);
  session_.run(0.3);
  EXPECT_TRUE(predicted()->header.stamp.isZero());
  EXPECT_EQ(toVector(predicted()->wrench.force), Eigen::Vector3d::Zero());
  EXPECT_FALSE(state()->converged);
  const auto* solver = session_.diagnostics().of("cell_simulator: solver");
  ASSERT_NE(solver, nullptr);
  EXPECT_NE(solver->level, 0);
  EXPECT_NE(solver->message.find("no valid needle pose"), std::string::npos) << solver->message;
  press();  // and it goes on
}

INSTANTIATE_TEST_SUITE_P(
    Poses, CellSimulatorTrustTest,
    testing::Values(
        UntrustedNeedle{"Silent", [](ScriptedNeedle& needle) { needle.publishNothing(); }},
        UntrustedNeedle{"Invalid", [](ScriptedNeedle& needle) { needle.publishInvalid(); }},
        UntrustedNeedle{"NotANumber", [](ScriptedNeedle& needle) { needle.publish(poseMessage(0, 0, NAN)); }},
        UntrustedNeedle{"Infinite", [](ScriptedNeedle& needle) { needle.publish(poseMessage(0, 0, -INFINITY)); }},
        UntrustedNeedle{"InAnotherFrame",
                        [](ScriptedNeedle& needle) { needle.publish(poseMessage(0, 0, 25e-6, "camera")); }}),
    [](const auto& needle) { return needle.param.name; });

}  // namespace
}  // namespace microinjection
