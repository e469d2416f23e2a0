// Plausible values of another node on the topics by which the controller moves the needle.

#include <gtest/gtest.h>

#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

class RivalMeasurementsTest : public testing::TestWithParam<const char*> {
 protected:
  /// A stranger's value, as the session's own node would send it.
  void contest() {
    const std::string topic = GetParam();
    TestNode& stranger = chain_.session.world();
    if (topic == "needle/measured_cp") {
      stranger.repeat<geometry_msgs::PoseStamped>(topic, [this] {
        geometry_msgs::PoseStamped pose = *chain_.session.world().hear<geometry_msgs::PoseStamped>(GetParam()).newest();
        pose.header.stamp = chain_.session.world().bus().now();
        pose.pose.position.z += 20e-6;
        return std::optional(pose);
      });
    } else {
      stranger.repeat<geometry_msgs::WrenchStamped>(topic, [this] {
        return std::optional(toWrench({0, 0, 0.05e-6}, chain_.session.world().bus().now(), kWorldFrame));
      });
    }
  }
  std::vector<std::string> overrides() const {
    const bool measured = std::string(GetParam()) == "force_sensor/measured_cf";
    return {std::string("overrides.injection_controller.force_source:=") + (measured ? "measured" : "predicted")};
  }

  InjectionChain chain_{overrides()};
};

TEST_P(RivalMeasurementsTest, HoldTheNeedleAndGiveNoPulse) {
  chain_.say("approach");
  ASSERT_TRUE(chain_.reaches("indent"));
  contest();
  chain_.session.run(0.2);
  const Eigen::Vector3d held = chain_.resting();
  chain_.session.run(2);
  EXPECT_LT((chain_.needle() - held).z(), 1);  // the stranger's pose may be the newest
  EXPECT_EQ(chain_.status().punctures, 0u);
  EXPECT_EQ(chain_.injector().pulses, 0u);
  EXPECT_FALSE(chain_.injector().busy);
  EXPECT_NE(chain_.status().state, "inject");
  EXPECT_EQ(chain_.status().outcome, "guard") << chain_.status();
}

INSTANTIATE_TEST_SUITE_P(Topics, RivalMeasurementsTest,
                         testing::Values("cell/predicted_cf", "force_sensor/measured_cf", "needle/measured_cp"),
                         [](const auto& topic) {
                           std::string name = topic.param;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace microinjection
