#include "cell_microinjection/InjectionPulse.h"
#include "led_session.h"

namespace microinjection {
namespace {

/// Without the ROS master all rests; test/chain/master.test has how the nodes find out.
class LostMasterTest : public testing::Test {
 protected:
  LostMasterTest() {
    session().world().publisher<cell_microinjection::InjectionPulse>("injector/pulse");
    chain_.hand().press(5e-6);
    chain_.hand().sway(0.5e-3, 5e-3);  // it stays in the cell
    expectFollows();
  }

  VirtualSession& session() { return chain_.session(); }
  double now() { return session().now().toSec(); }
  void expectFollows() {
    const double begin = now();
    session().run(0.3);
    EXPECT_GT(chain_.needle().since(begin).span(), 0.4e-6);
    EXPECT_GT(chain_.hand().force().z(), 0.05);
  }
  void expectRests(double seconds) {
    const double begin = now();
    session().run(seconds);
    EXPECT_LT(chain_.needle().since(begin).span(), LedSession::kStill);
    for (const auto& force : chain_.force().since(begin).values) ASSERT_EQ(force.norm(), 0);
  }

  LedSession chain_;
};

TEST_F(LostMasterTest, AllRestsWithoutItAndGoesOnWithItButForThePulse) {
  cell_microinjection::InjectionPulse pulse;
  pulse.id = 1;
  pulse.pressure = 20e3;
  pulse.duration = 60;
  session().world().sayNow("injector/pulse", pulse);
  expectFollows();
  EXPECT_TRUE(chain_.injector().newest()->busy);

  session().executive().loseMaster(true);
  session().run(0.05);
  expectRests(0.5);
  EXPECT_FALSE(chain_.injector().newest()->busy);
  for (const char* node : LedSession::kNodes) {
    const std::string said = session().diagnostics().text(std::string(node) + ": inputs");
    EXPECT_NE(said.find("the ROS master is lost"), std::string::npos) << node << ": " << said;
  }
  session().diagnostics().clear();
  session().world().sayNow("needle/move_cp", poseMessage(0, 0, 40e-6));
  pulse.id = 2;
  session().world().sayNow("injector/pulse", pulse);
  expectRests(0.5);
  EXPECT_TRUE(session().diagnostics().ever("micromanipulator: commands", "the ROS master is lost"));
  EXPECT_FALSE(chain_.injector().newest()->busy);
  EXPECT_NE(chain_.injector().newest()->refusal.find("the ROS master is lost"), std::string::npos);

  session().executive().loseMaster(false);
  session().run(0.5);
  expectFollows();
  EXPECT_FALSE(chain_.injector().newest()->busy);
  chain_.expectEnabled();
}

TEST_F(LostMasterTest, BridgeThatIsAskedToEndSaysZeroForceAndNoTargetAtTheLast) {
  const std::size_t forces = chain_.forces().count(), targets = chain_.target().count();
  session().executive().end("haptic_bridge");
  session().run(0.2);
  EXPECT_EQ(chain_.forces().count(), forces + 5);
  for (std::size_t i = forces; i < chain_.forces().count(); ++i)
    EXPECT_EQ(toVector(chain_.forces().all()[i]->wrench.force).norm(), 0);
  ASSERT_GT(chain_.target().count(), targets);
  EXPECT_TRUE(chain_.target().newest()->header.stamp.isZero());
  EXPECT_FALSE(chain_.target().all()[targets - 1]->header.stamp.isZero());
  session().executive().restart("haptic_bridge");
  session().run(0.5);
  expectFollows();
}

}  // namespace
}  // namespace microinjection
