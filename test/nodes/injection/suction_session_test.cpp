#include <gtest/gtest.h>

#include "cell_microinjection/BoreState.h"
#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

using cell_microinjection::BoreState;
using cell_microinjection::InjectResult;

constexpr double kBreaks = 1500;  // Pa, of suction, that breaks the membrane of aspirated_oocyte.yaml

/// A session whose needle has a bore: controller, injector and cell over topics, on virtual time.
class SuctionSessionTest : public testing::Test {
 protected:
  SuctionSessionTest() { chain_.session.world().hear<BoreState>("cell/bore"); }

  static cell_microinjection::InjectGoal suctionGoal() {
    auto goal = punctureGoal();
    goal.break_by = "suction";
    goal.dent = 4e-6;
    goal.suction = 3e3;
    goal.suction_rate = 2e3;
    goal.suction_time = 0.5;
    goal.suction_length = 30e-6;
    return goal;
  }
  InjectResult result() {
    EXPECT_TRUE(chain_.session.until([&] { return client_.ended(); }, 60)) << chain_.status();
    return client_.ended() ? *client_.result() : InjectResult();
  }
  const BoreState& bore() {
    static const BoreState none;
    const BoreState* const newest = chain_.session.world().hear<BoreState>("cell/bore").newest();
    return newest ? *newest : none;
  }

  InjectionChain chain_{{}, "aspirated_oocyte"};
  ActionClient<cell_microinjection::InjectAction> client_{chain_.session.world(), "controller/inject"};
};

TEST_F(SuctionSessionTest, DrawsTheMembraneInUntilItBreaksAndInjects) {
  client_.send(suctionGoal());
  ASSERT_TRUE(chain_.session.until([&] { return chain_.status().state == "aspirate"; }, 30)) << chain_.status();
  // A tongue stands in the bore, and no liquid leaves the injector's needle but what it makes room for.
  ASSERT_TRUE(chain_.session.until([&] { return bore().suction > 0.6 * kBreaks; }, 5));
  EXPECT_TRUE(bore().covered);
  EXPECT_GT(bore().length, 0.1e-6);
  EXPECT_GT(bore().tension, 0.5e-3);
  EXPECT_LT(-chain_.injector().flow,
            0.2 * (chain_.injector().rest_pressure - chain_.injector().pressure) / chain_.injector().resistance);
  const InjectResult done = result();
  EXPECT_EQ(done.outcome, "injected") << done.reason;
  EXPECT_NEAR(done.break_suction, kBreaks, 0.15 * kBreaks);
  EXPECT_EQ(done.false_breaks, 0);
  EXPECT_TRUE(chain_.cell().punctured);
  EXPECT_EQ(chain_.passed(), (std::vector<std::string>{"approach", "contact", "indent", "aspirate", "punctured",
                                                       "inject", "punctured", "withdraw"}));
  EXPECT_GT(chain_.injector().volume, 0);
}

TEST_F(SuctionSessionTest, ACancelEndsTheSuction) {
  client_.send(suctionGoal());
  ASSERT_TRUE(chain_.session.until([&] { return bore().suction > 500; }, 30)) << chain_.status();
  client_.cancel();
  EXPECT_TRUE(chain_.session.until([&] { return !chain_.injector().busy; }, 0.05));
  EXPECT_EQ(result().outcome, "preempted");
  EXPECT_FALSE(chain_.cell().punctured);
}

TEST_F(SuctionSessionTest, AGoalThatCannotBeIsRefused) {
  auto goal = suctionGoal();
  goal.break_by = "hammer";
  client_.send(goal);
  InjectResult done = result();
  EXPECT_EQ(done.outcome, "refused");
  EXPECT_NE(done.reason.find("break_by = hammer, allowed force, suction"), std::string::npos) << done.reason;
}

/// DISABLED in the midst of it: nothing draws any more.
TEST_F(SuctionSessionTest, DisabledItDrawsNoMore) {
  client_.send(suctionGoal());
  ASSERT_TRUE(chain_.session.until([&] { return bore().suction > 500; }, 30)) << chain_.status();
  chain_.say("disable");
  EXPECT_TRUE(chain_.session.until([&] { return !chain_.injector().busy; }, 0.05));
  chain_.session.run(0.1);
  EXPECT_LT(bore().suction, 20);
}

}  // namespace
}  // namespace microinjection
