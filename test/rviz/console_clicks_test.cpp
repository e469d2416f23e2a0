#include <gtest/gtest.h>
#include <sensor_msgs/FluidPressure.h>
#include <std_srvs/Trigger.h>

#include <random>

#include "cell_microinjection/InjectAction.h"
#include "cell_microinjection/InjectorState.h"
#include "console_bench.h"
#include "rviz/injection_box.h"
#include "rviz/number_field.h"
#include "scripted_action.h"

namespace microinjection {
namespace {

constexpr int kClicks = 40;

/// The test is the controller.
class ConsoleClicksTest : public testing::Test {
 protected:
  using Words = std::vector<std::string>;

  WindowUser& user() { return bench_.user(); }
  TestNode& world() { return session_.world(); }
  bool untilOffered(const std::string& button) {
    return bench_.until([&] { return user().offered(button); });
  }
  /// To a state that the console shows.
  void change(const std::string& state) {
    controller_.change(state);
    bench_.run(0.2);
  }

  VirtualSession session_{{"hand.device:=none"}};
  ShownController controller_{session_, "{mode: automatic, force_limit: '2e-5', depth_limit: '60 um'}"};
  ConsoleBench bench_{session_, "inject"};
};

TEST_F(ConsoleClicksTest, EveryClickIsACommand) {
  const QPoint enable = user().place("Enable"), disable = user().place("Disable");
  Words expected;
  for (int i = 0; i < kClicks; ++i) {
    const bool disabled = controller_.state() == "DISABLED";
    ASSERT_TRUE(untilOffered(disabled ? "Enable" : "Disable")) << i;
    ASSERT_EQ(user().place("Enable"), enable);
    ASSERT_EQ(user().place("Disable"), disable);
    user().click(disabled ? enable : disable);
    bench_.run(0.02);
    expected.push_back(disabled ? "enable" : "disable");
    ASSERT_EQ(bench_.sent(), expected) << "click " << i;
  }
}

TEST_F(ConsoleClicksTest, AClickOnAGreyedButtonIsNone) {
  ASSERT_TRUE(untilOffered("Enable"));
  ASSERT_FALSE(user().offered("Disable"));
  for (const char* button : {"Home", "Approach", "Indent", "Inject", "Withdraw", "Disable"}) user().click(button);
  bench_.run(0.1);
  EXPECT_EQ(bench_.sent(), Words());
}

/// The console shows what is older than what the controller says.
TEST_F(ConsoleClicksTest, WhatIsOfferedAtTheClickCounts) {
  change("ENABLED");
  ASSERT_TRUE(untilOffered("Disable"));
  controller_.change("DISABLED");
  ASSERT_TRUE(user().offered("Disable")) << "it has not been drawn yet";
  user().click("Disable");
  bench_.run(0.02);
  EXPECT_EQ(bench_.sent(), Words());
}

/// The offer comes and goes while the button is down; it counts what is offered at the release.
TEST_F(ConsoleClicksTest, AClickOutlastsARefusalBetweenPressAndRelease) {
  std::mt19937 random(7);
  std::uniform_real_distribution<> wait(0.1, 0.3);  // s
  Words expected;
  for (int i = 0; i < kClicks / 4; ++i) {
    ASSERT_TRUE(untilOffered("Enable")) << i;
    const QPoint place = user().place("Enable");
    user().press(place);
    for (const char* state : {"ENABLED", "DISABLED"}) {  // greyed, then offered again
      bench_.run(wait(random));
      controller_.change(state);
    }
    bench_.run(0.2);
    user().release(place);
    bench_.run(0.02);
    expected.push_back("enable");
    ASSERT_EQ(bench_.sent(), expected) << "click " << i;
    change("DISABLED");
  }
}

TEST_F(ConsoleClicksTest, StopIsSentAtThePress) {
  change("ENABLED");
  const QPoint place = user().place("STOP");
  user().press(place);
  bench_.run(0.02);
  EXPECT_EQ(bench_.sent(), Words{"pause"});
  user().release(place);
  bench_.run(0.02);
  EXPECT_EQ(bench_.sent(), Words{"pause"});
}

TEST_F(ConsoleClicksTest, LimitsThatAreTextAreReadOrShown) {
  controller_.status.guard_force = 18e-6;  // 90 % of 2e-5
  bench_.run(0.3);
  EXPECT_EQ(user().guard("Force"), "yellow");
  EXPECT_EQ(user().guard("Depth"), "empty");
  change("ENABLED");
  EXPECT_EQ(bench_.headline(), "yellow");
  EXPECT_NE(bench_.headlineText().find("depth_limit"), std::string::npos) << bench_.headlineText();
}

/// What is sent before is lost.
TEST_F(ConsoleClicksTest, NothingIsOfferedBeforeTheControllerListens) {
  controller_.deafen();
  bench_.run(0.2);
  EXPECT_EQ(bench_.headline(), "grey");
  EXPECT_EQ(user().allOffered(), std::set<std::string>());
  controller_.listen();
  ASSERT_TRUE(untilOffered("Enable"));
  user().click("Enable");
  bench_.run(0.02);
  EXPECT_EQ(controller_.state(), "ENABLED");
}

TEST_F(ConsoleClicksTest, NothingIsOfferedOfAControllerThatIsGone) {
  ASSERT_TRUE(untilOffered("Enable"));
  session_.executive().freeze("injection_controller");
  bench_.run(1.2);
  EXPECT_EQ(bench_.headline(), "red");
  EXPECT_EQ(user().allOffered(), std::set<std::string>());
  user().click("STOP");
  bench_.run(0.02);
  EXPECT_EQ(bench_.sent(), Words{"disable"});
}

/// The test is the action's node, too.
class AutomaticInjectionTest : public ConsoleClicksTest {
 protected:
  using Injections = ScriptedAction<cell_microinjection::InjectAction>;

  AutomaticInjectionTest() {
    session_.executive().add("injections", [this](Bus& bus) {
      injections_ = std::make_shared<Injections>(bus, "controller/inject");
      injections_->feedback.state = "indent";
      injections_->feedback.layer = 1;
      injections_->feedback.layers = 2;
      injections_->feedback.depth = 3e-6;
      injections_->feedback.force = 1e-6;
      injections_->when_cancelled.outcome = "preempted";
      return injections_;
    });
    bench_.run(1);
    change("ENABLED");
  }
  ~AutomaticInjectionTest() override { injections_.reset(); }

  std::pair<std::string, std::string> report() { return WindowUser::lampIn(*user().shown<InjectionBox>().at(0)); }
  void click(const std::string& button) {
    user().click(button);
    bench_.run(0.3);
  }

  std::shared_ptr<Injections> injections_;
};

TEST_F(AutomaticInjectionTest, HasAButtonProgressAndAnOutcome) {
  ASSERT_TRUE(user().offered("Start")) << user().beside("Start");
  ASSERT_FALSE(user().offered("Cancel"));
  click("Start");
  ASSERT_EQ(injections_->goals.size(), 1u);
  EXPECT_TRUE(injections_->goals[0].configured);
  EXPECT_EQ(report().first, "yellow");
  EXPECT_EQ(report().second.find("indent, layer 1 of 2, 3.0 um deep"), 0u) << report().second;
  EXPECT_FALSE(user().offered("Start"));
  cell_microinjection::InjectResult result;
  result.outcome = "injected";
  result.punctures = 2;
  result.volume = 5e-15;
  injections_->succeed(result);
  bench_.run(0.3);
  EXPECT_EQ(report(), std::pair(std::string("green"), std::string("injected: 5.0 pL through 2 membranes")));
  EXPECT_TRUE(user().offered("Start"));
}

TEST_F(AutomaticInjectionTest, CancelEndsItAndAnotherOneCanBegin) {
  click("Start");
  ASSERT_TRUE(user().offered("Cancel"));
  click("Cancel");
  EXPECT_EQ(report(), std::pair(std::string("red"), std::string("preempted")));
  click("Start");
  EXPECT_EQ(injections_->goals.size(), 2u);
  EXPECT_EQ(report().first, "yellow");
}

TEST_F(AutomaticInjectionTest, EndsWithTheControllerThatHasIt) {
  click("Start");
  injections_.reset();
  session_.executive().kill("injections");
  bench_.run(0.3);
  EXPECT_EQ(report(), std::pair(std::string("red"), std::string("injection_controller has ended")));
  EXPECT_FALSE(user().offered("Start"));
  EXPECT_EQ(user().beside("Start"), "/controller/inject does not answer");
}

TEST_F(AutomaticInjectionTest, IsLostWithAControllerThatWasStartedAgain) {
  click("Start");
  injections_.reset();
  session_.executive().restart("injections");
  bench_.run(0.5);
  EXPECT_EQ(report().first, "red");
  EXPECT_EQ(report().second.find("LOST"), 0u) << report().second;
  EXPECT_TRUE(user().offered("Start"));
}

/// The test is the injector, too.
class InjectorBarTest : public ConsoleClicksTest {
 protected:
  InjectorBarTest() {
    session_.executive().network().setParameter("/injector/balance", YAML::Node("545"));
    service_ = world().bus().advertiseService<std_srvs::Trigger>("/injector/reset", [this](auto&, auto& answer) {
      ++resets_;
      answer.success = static_cast<unsigned char>(reset_refusal_.empty());
      answer.message = reset_refusal_;
      return true;
    });
    world().hear<sensor_msgs::FluidPressure>("injector/set_balance");
    world().repeat<cell_microinjection::InjectorState>("injector/state", [this] {
      cell_microinjection::InjectorState state;
      state.busy = static_cast<unsigned char>(busy_);
      return std::optional(state);
    });
    bench_.run(0.3);
  }

  std::vector<double> balances() {
    std::vector<double> all;
    for (const auto& message : world().hear<sensor_msgs::FluidPressure>("injector/set_balance").all())
      all.push_back(message->fluid_pressure);
    return all;
  }
  /// Into the field for the pressure, without Enter.
  void type(const QString& keys) {
    NumberField& field = *user().shown<NumberField>().at(0);
    user().click(QPoint(field.mapTo(&bench_.console(), QPoint(15, field.height() / 2))));
    ASSERT_TRUE(field.hasFocus());
    QTest::keyClick(&field, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClicks(&field, keys);
  }
  void click(const std::string& button) {
    user().click(button);
    bench_.run(0.3);
  }

  bool busy_ = false;
  int resets_ = 0;
  std::string reset_refusal_;
  BusHandle service_;
};

TEST_F(InjectorBarTest, SetsThePressureOfItsParameterOrTheOneThatIsTyped) {
  ASSERT_TRUE(user().offered("Set"));
  click("Set");
  EXPECT_EQ(balances(), std::vector<double>{545});
  type("605");
  click("Set");
  EXPECT_EQ(balances(), (std::vector<double>{545, 605}));
}

TEST_F(InjectorBarTest, ResetsButNotDuringAPulse) {
  click("Reset");
  EXPECT_EQ(resets_, 1);
  busy_ = true;
  bench_.run(0.3);
  EXPECT_FALSE(user().offered("Reset"));
  EXPECT_TRUE(user().offered("Set"));
  click("Reset");
  busy_ = false;
  bench_.run(0.3);
  EXPECT_TRUE(user().offered("Reset"));
  EXPECT_EQ(resets_, 1);
}

TEST_F(InjectorBarTest, ARefusedResetSaysWhy) {
  reset_refusal_ = "the pipette is clogged";
  click("Reset");
  bool said = false;
  for (const ElidedLabel* text : user().shown<ElidedLabel>())
    said = said || text->toolTip() == "the pipette is clogged";
  EXPECT_TRUE(said);
}

TEST_F(InjectorBarTest, TheSpaceBarStopsWhileTheFieldHasTheFocus) {
  change("ENABLED");
  type("7");
  QTest::keyClick(QApplication::focusWidget(), Qt::Key_Space);
  bench_.run(0.1);
  EXPECT_EQ(bench_.sent(), Words{"pause"});
}

TEST_F(InjectorBarTest, OffersNothingOfAnInjectorThatIsGone) {
  service_.reset();
  world().hangUp("injector/state");
  bench_.run(2.5);
  EXPECT_FALSE(user().offered("Set") || user().offered("Reset"));
}

}  // namespace
}  // namespace microinjection
