// Sources that contradict each other while the controller moves the needle by itself.

#include <gtest/gtest.h>

#include <random>

#include "cell_microinjection/CellParameters.h"
#include "cell_microinjection/VisionState.h"
#include "nodes/injection/injection_chain.h"

namespace microinjection {
namespace {

class WitnessesTest : public testing::Test {
 protected:
  using Wrench = geometry_msgs::WrenchStamped;
  static constexpr const char* kMeasured = "overrides.injection_controller.force_source:=measured";

  /// From now on each value of the topic is what `value` makes of it.
  void alterForce(InjectionChain& chain, const std::string& topic, std::function<void(Wrench&)> change) {
    chain.session.executive().network().alter(topic, [change](Passage passage) {
      auto altered = boost::make_shared<Wrench>(*boost::static_pointer_cast<const Wrench>(passage.message));
      change(*altered);
      passage.message = altered;
      return std::vector<Passage>{passage};
    });
  }
  /// N, of 10 nN rms.
  double noise() { return noise_(random_); }
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0, 10e-9};

  /// From now on an image each 30 ms, in which the tip is so far (m) before the outline of the cell.
  static void showTip(InjectionChain& chain, double gap) {
    constexpr double kPixel = 0.25e-6;  // m
    chain.session.addTestNode("seer", 0.03).repeat<cell_microinjection::VisionState>("vision/state", [gap] {
      cell_microinjection::VisionState state;
      state.pixel_size = kPixel;
      state.cell.verdict = state.cell.FOUND;
      state.injection_pipette.verdict = state.injection_pipette.FOUND;
      state.indentation.gap = gap / kPixel;
      return std::optional(state);
    });
  }
  static void expectHeldWith(InjectionChain& chain, const std::string& words) {
    EXPECT_TRUE(chain.session.until([&] { return chain.status().outcome == "guard"; }, 10)) << chain.status();
    EXPECT_NE(chain.status().reason.find(words), std::string::npos) << chain.status().reason;
    EXPECT_EQ(chain.injector().pulses, 0u);
    EXPECT_EQ(chain.status().punctures, 0u);
  }
  static void expectHeldBeforeAPuncture(InjectionChain& chain) {
    EXPECT_TRUE(chain.session.until([&] { return chain.status().outcome == "guard"; }, 30)) << chain.status();
    EXPECT_NE(chain.status().reason.find("the sensor"), std::string::npos) << chain.status().reason;
    EXPECT_EQ(chain.injector().pulses, 0u);
    const Eigen::Vector3d held = chain.resting();
    chain.session.run(2);
    EXPECT_LT((chain.needle() - held).norm(), 0.1e-6);
    EXPECT_FALSE(chain.cell().inside);
  }
};

/// Its cable is out; the amplifier still has its noise, or the reading would repeat.
TEST_F(WitnessesTest, ADeadSensorHoldsTheApproach) {
  InjectionChain chain({kMeasured}, "tough_oocyte");
  alterForce(chain, "/force_sensor/measured_cf", [this](Wrench& wrench) {
    wrench.wrench.force.x = wrench.wrench.force.y = 0;
    wrench.wrench.force.z = noise();
  });
  chain.say("approach");
  expectHeldBeforeAPuncture(chain);
}

/// Each reading is one sample, although the controller reads it ten times: its noise is no touch.
TEST_F(WitnessesTest, ASensorThatStandsStillAgainAndAgainIsBelieved) {
  InjectionChain chain({kMeasured}, "tough_oocyte");
  chain.session.executive().network().alter("/force_sensor/measured_cf", [this, count = 0](Passage passage) mutable {
    if (count++ % 10 != 0) return std::vector<Passage>{};
    auto noisy = boost::make_shared<Wrench>(*boost::static_pointer_cast<const Wrench>(passage.message));
    noisy->wrench.force.z += 3 * noise();
    passage.message = noisy;
    return std::vector<Passage>{passage};
  });
  chain.say("enable");  // the noise is measured anew
  chain.say("approach");
  EXPECT_TRUE(
      chain.session.until([&] { return chain.status().state == "contact" || !chain.status().reason.empty(); }, 30))
      << chain.status();
  EXPECT_EQ(chain.status().reason, "");
  EXPECT_TRUE(chain.cell().in_contact) << chain.needle().transpose();
}

TEST_F(WitnessesTest, ASensorThatFreezesAtTheTouchHoldsTheNeedle) {
  InjectionChain chain({kMeasured}, "tough_oocyte");
  std::optional<geometry_msgs::Wrench> frozen;
  alterForce(chain, "/force_sensor/measured_cf", [&](Wrench& wrench) {
    if (!frozen && chain.cell().in_contact) frozen = wrench.wrench;
    if (!frozen) return;
    wrench.wrench = *frozen;
    wrench.wrench.force.z += noise();
  });
  chain.say("approach");
  expectHeldBeforeAPuncture(chain);
}

TEST_F(WitnessesTest, AnImageOfTheTipBeforeTheCellHoldsTheNeedle) {
  InjectionChain chain({}, "tough_oocyte");
  showTip(chain, 5e-6);
  chain.say("approach");
  expectHeldWith(chain, "the image shows the tip 5e-06 m before the cell");
  EXPECT_LT(chain.status().depth, 11e-6);
}

/// The needle may be above the cell in the view, or the image of before.
TEST_F(WitnessesTest, AnImageOfTheTipInTheCellSaysNothing) {
  InjectionChain chain({}, "tough_oocyte");
  showTip(chain, -5e-6);
  chain.say("approach");
  EXPECT_TRUE(chain.session.until([&] { return chain.status().depth > 13e-6; }, 10)) << chain.status();
  EXPECT_EQ(chain.status().state, "indent");
}

TEST_F(WitnessesTest, AWitnessThatTwoNodesSendHoldsTheNeedle) {
  InjectionChain chain({}, "tough_oocyte");
  chain.say("approach");
  ASSERT_TRUE(chain.reaches("indent"));
  chain.session.addTestNode("stranger").repeat<Wrench>("force_sensor/measured_cf", [this] {
    return std::optional(wrenchMessage(0, 0, 0.3e-6 + noise(), "needle_tip"));
  });
  expectHeldWith(chain, "is sent by two nodes");
}

TEST_F(WitnessesTest, AWitnessThatRepeatsItselfHoldsTheNeedle) {
  InjectionChain chain({}, "tough_oocyte");
  chain.say("approach");
  ASSERT_TRUE(chain.reaches("indent"));
  std::optional<geometry_msgs::Wrench> frozen;
  alterForce(chain, "/force_sensor/measured_cf", [&](Wrench& wrench) {
    if (!frozen) frozen = wrench.wrench;
    wrench.wrench = *frozen;
  });
  const Eigen::Vector3d from = chain.needle();
  expectHeldWith(chain, "repeats one reading");
  EXPECT_LT((chain.needle() - from).norm(), 2e-6);
}

TEST_F(WitnessesTest, AForceThatFallsWithoutAPunctureGivesNoPulse) {
  // As by a served cell that becomes softer: the cell is intact, and says so.
  InjectionChain chain({}, "tough_oocyte");
  double share = 1;
  alterForce(chain, "/cell/predicted_cf", [&share](Wrench& wrench) { wrench.wrench.force.z *= share; });
  chain.say("approach");
  ASSERT_TRUE(chain.reaches("indent"));
  ASSERT_TRUE(chain.session.until([&] { return chain.status().depth > 2e-6; }));
  share = 0.4;
  EXPECT_TRUE(chain.session.until([&] { return chain.status().outcome == "guard"; }, 30)) << chain.status();
  EXPECT_NE(chain.status().reason.find("is not punctured"), std::string::npos) << chain.status().reason;
  EXPECT_EQ(chain.injector().pulses, 0u);
}

TEST_F(WitnessesTest, NewsOfAChangedCellKeepItsFallFromBeingAPuncture) {
  InjectionChain chain({}, "tough_oocyte");
  double share = 1;
  alterForce(chain, "/cell/predicted_cf", [&share](Wrench& wrench) { wrench.wrench.force.z *= share; });
  chain.session.world().publisher<cell_microinjection::CellParameters>("cell/parameters");
  chain.say("approach");
  ASSERT_TRUE(chain.reaches("indent"));
  ASSERT_TRUE(chain.session.until([&] { return chain.status().depth > 2e-6; }));
  cell_microinjection::CellParameters news;
  news.header.stamp = chain.session.world().bus().now();
  news.name = {"young_modulus"};
  news.value = {7e3};
  chain.session.world().say("cell/parameters", news);
  share = 0.4;
  chain.session.run(0.1);
  EXPECT_EQ(chain.status().punctures, 0u);
  EXPECT_EQ(chain.status().state, "indent");
}

/// An estimator serves what it has learned, again and again: that must not hide a puncture.
TEST_F(WitnessesTest, NewsOfSmallChangesHideNoPuncture) {
  InjectionChain chain;
  double modulus = 17.9e3;
  chain.session.world().repeat<cell_microinjection::CellParameters>("cell/parameters", [&] {
    cell_microinjection::CellParameters news;
    news.header.stamp = chain.session.world().bus().now();
    news.name = {"young_modulus", "height"};
    news.value = {modulus, 1e-7};
    modulus = modulus > 17.9e3 ? 17.8e3 : 18e3;
    return std::optional(news);
  });
  chain.session.run(0.1);
  chain.say("approach");
  EXPECT_TRUE(chain.session.until([&] { return chain.status().punctures > 0; }, 30)) << chain.status();
}

}  // namespace
}  // namespace microinjection
