#include <gtest/gtest.h>

#include <tuple>

#include "cell_microinjection/CellHold.h"
#include "cell_microinjection/HoldingSeal.h"
#include "holder_world.h"
#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

using cell_microinjection::CellHold;

constexpr double kHeldWith = 1500;  // Pa

/// A session whose cell is held by the holder's suction: controller, holder and cell over topics, on virtual time.
class HoldingSessionTest : public testing::Test {
 protected:
  HoldingSessionTest() { chain_.session.world().hear<CellHold>("cell/hold"); }

  static cell_microinjection::InjectGoal heldGoal() {
    auto goal = punctureGoal();
    goal.depth = 40e-6;
    goal.holding_suction = kHeldWith;
    goal.holding_time = 5;
    goal.release = true;
    goal.release_pressure = 200;
    goal.release_time = 1;
    return goal;
  }
  const CellHold& hold() {
    static const CellHold none;
    const CellHold* const newest = chain_.session.world().hear<CellHold>("cell/hold").newest();
    return newest ? *newest : none;
  }
  cell_microinjection::InjectResult result() {
    EXPECT_TRUE(chain_.session.until([&] { return client_.ended(); }, 90)) << chain_.status();
    return client_.ended() ? *client_.result() : cell_microinjection::InjectResult();
  }

  InjectionChain chain_{{"model:=auto", "holder:=sim", "cell:=mouse_oocyte_held"}};
  HolderWorld holder_{chain_.session};
  ActionClient<cell_microinjection::InjectAction> client_{chain_.session.world(), "controller/inject"};
};

TEST_F(HoldingSessionTest, TakesTheCellInjectsIntoItAndLetsItGo) {
  chain_.session.run(0.2);
  EXPECT_NE(hold().mode, "held") << "nothing holds it at the start";
  client_.send(heldGoal());
  ASSERT_TRUE(chain_.reaches("hold"));
  ASSERT_TRUE(chain_.reaches("approach"));
  EXPECT_EQ(hold().mode, "held");
  EXPECT_TRUE(hold().sealed);
  EXPECT_NEAR(hold().pressure, -kHeldWith, 0.11 * kHeldWith);
  EXPECT_GT(hold().tongue, 1e-6);
  EXPECT_EQ(holder_.state().commander, "/injection_controller");
  const auto done = result();
  EXPECT_EQ(done.outcome, "injected") << done.reason;
  EXPECT_EQ(done.reason, "");
  const std::vector<std::string> passed = chain_.passed();
  EXPECT_EQ(passed.front(), "hold");
  EXPECT_EQ(passed.back(), "release");
  EXPECT_TRUE(chain_.session.until([&] { return holder_.state().target == 0; }, 1));
  EXPECT_NE(hold().mode, "held");
}

/// Somebody else lets the cell go while the needle is in the dent: it is lost, and nothing goes on.
TEST_F(HoldingSessionTest, ACellThatIsLostStopsTheNeedle) {
  client_.send(heldGoal());
  ASSERT_TRUE(chain_.reaches("indent"));
  chain_.session.run(0.2);
  holder_.set(500);
  const auto done = result();
  EXPECT_EQ(done.outcome, "guard");
  EXPECT_NE(done.reason.find("does not hold the cell"), std::string::npos) << done.reason;
  EXPECT_EQ(chain_.status().state, "indent");
  const Eigen::Vector3d before = chain_.needle();
  chain_.session.run(0.5);
  EXPECT_LT((chain_.needle() - before).norm(), 0.3e-6);
}

/// The same suction again, after somebody has taken it away.
TEST_F(HoldingSessionTest, HoldsAnew) {
  auto goal = heldGoal();
  goal.release = false;
  goal.puncture = false;
  goal.depth = 2e-6;
  for (int i = 0; i < 2; ++i) {
    client_.send(goal);
    EXPECT_EQ(result().outcome, "indented") << i;
    EXPECT_EQ(hold().mode, "held") << i;
    chain_.session.run(1.5);
    holder_.set(0);
    chain_.session.run(5);  // many of the line's time constants
    EXPECT_EQ(holder_.state().target, 0) << "nobody is overruled";
    EXPECT_NE(hold().mode, "held");
  }
}

/// A holder that dies or hangs keeps its pressure: the needle ends its way, and it is said that the cell is still held.
class HolderDies : public HoldingSessionTest, public testing::WithParamInterface<std::tuple<const char*, bool>> {};

TEST_P(HolderDies, TheNeedleGoesOn) {
  const auto [state, frozen] = GetParam();
  client_.send(heldGoal());
  ASSERT_TRUE(chain_.reaches(state));
  chain_.session.run(0.02);
  frozen ? chain_.session.executive().freeze("holder") : chain_.session.executive().kill("holder");
  const auto done = result();
  const std::string step = state;
  if (step == "hold") {
    EXPECT_EQ(done.outcome, "not_held");
    EXPECT_NE(done.reason.find("no valid state of the holder"), std::string::npos) << done.reason;
  } else {
    EXPECT_EQ(done.outcome, "injected") << done.reason;
    EXPECT_EQ(done.reason, "the cell was not let go: no valid state of the holder");
  }
  if (step != "hold") EXPECT_EQ(hold().mode, "held");
}

INSTANTIATE_TEST_SUITE_P(
    InEachStep, HolderDies,
    testing::Combine(testing::Values("hold", "approach", "indent", "inject", "withdraw", "release"), testing::Bool()));

}  // namespace
}  // namespace microinjection
