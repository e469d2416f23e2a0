#include <gtest/gtest.h>

#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

/// Every step waits for its word on /controller/state_command, and takes no other.
class SemiAutomaticTest : public testing::Test {
 protected:
  /// It goes on to `state` and waits there, with the needle at rest.
  void expectWaitsIn(const std::string& state) {
    const auto waits = [&] { return chain_.status().state == state && chain_.status().waits; };
    ASSERT_TRUE(chain_.session.until(waits, 30)) << state << " is not reached: " << chain_.status();
    chain_.session.run(0.1);
    const Eigen::Vector3d at = chain_.needle();
    chain_.session.run(0.2);
    EXPECT_LT((chain_.needle() - at).cwiseAbs().maxCoeff(), 0.02e-6);
    EXPECT_TRUE(waits()) << chain_.status();
  }
  void expectRefused(const std::vector<std::string>& words) {
    const auto before = chain_.passed();
    for (const std::string& word : words) {
      chain_.say(word);
      chain_.session.run(0.05);
      EXPECT_EQ(chain_.passed(), before) << word;
    }
  }

  InjectionChain chain_{{"injection.mode:=semi_automatic"}};
  const Eigen::Vector3d start_ = chain_.resting();
};

TEST_F(SemiAutomaticTest, GivenUpAtTheTouchTheCellIsWhole) {
  expectRefused({"indent", "inject", "withdraw"});
  chain_.say("approach");
  expectWaitsIn("contact");
  chain_.say("withdraw");
  EXPECT_TRUE(chain_.session.until([&] { return chain_.status().outcome == "preempted"; })) << chain_.status();
  chain_.expectOut(start_);
  EXPECT_FALSE(chain_.cell().punctured);
}

TEST_F(SemiAutomaticTest, AWholeInjectionStepByStep) {
  const cell_microinjection::InjectorState before = chain_.injector();
  chain_.say("approach");
  expectWaitsIn("contact");
  expectRefused({"approach", "inject"});
  chain_.say("indent");
  expectWaitsIn("punctured");
  EXPECT_TRUE(chain_.cell().punctured);
  EXPECT_EQ(chain_.injector().pulses, before.pulses);
  expectRefused({"approach", "indent"});
  chain_.say("inject");
  ASSERT_TRUE(chain_.reaches("inject"));
  expectWaitsIn("punctured");
  EXPECT_EQ(chain_.injector().pulses, before.pulses + 1);
  const double pulse = 0.3 * 2.46e3 / 1.546e17;  // m^3: 0.3 s of 3 kPa past the capillary pressure, over the resistance
  EXPECT_NEAR(chain_.status().volume / pulse, 1, 0.05);
  expectRefused({"inject"});
  chain_.say("withdraw");
  EXPECT_TRUE(chain_.session.until([&] { return chain_.status().outcome == "injected"; })) << chain_.status();
  chain_.expectOut(start_);
  EXPECT_EQ(chain_.waited(), (std::set<std::string>{"contact", "punctured"}));
  EXPECT_EQ(chain_.passed(), (std::vector<std::string>{"approach", "contact", "indent", "punctured", "inject",
                                                       "punctured", "withdraw"}));
}

}  // namespace
}  // namespace microinjection
