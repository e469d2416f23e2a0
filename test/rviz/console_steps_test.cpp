#include <gtest/gtest.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <QWheelEvent>

#include "console_bench.h"
#include "nodes/runtime/conversions.h"
#include "rviz/focus_bar.h"
#include "rviz/microscope_view.h"

namespace microinjection {
namespace {

using cell_microinjection::OperatingState;
using cell_microinjection::StringStamped;

const Eigen::Vector3d kTip(1e-6, -2e-6, 80e-6);  // m

/// The test is a needle and a focus that are at once where they are sent, and the controller.
class ConsoleStepsTest : public testing::Test {
 protected:
  ConsoleStepsTest() {
    bench_.setNeedle([this](double) -> std::optional<Eigen::Isometry3d> {
      if (!tip_known_) return std::nullopt;
      return Eigen::Isometry3d(Eigen::Translation3d(tip_));
    });
    moves_ = world().bus().subscribe<geometry_msgs::PoseStamped>("needle/move_cp", 10, [this](const auto& delivery) {
      sent_.push_back(*delivery.message);
      if (!busy_) tip_ = toVector(delivery.message->pose.position);
    });
    world().hear<StringStamped>("needle/state_command");
    report(false);
    bench_.run(0.2);
  }

  TestNode& world() { return session_.world(); }
  WindowUser& user() { return bench_.user(); }
  /// The needle moves, or it rests.
  void report(bool busy, const std::string& state = "ENABLED") {
    busy_ = busy;
    OperatingState message;
    message.state = state;
    message.is_homed = true;
    message.is_busy = busy;
    world().say("needle/operating_state", message, true);
    bench_.run(0.2);
  }
  void press(const std::string& button) {
    user().click(button);
    bench_.run(0.05);
  }
  bool allOffered() {
    int offered = 0;
    for (const char* button : kButtons) offered += user().offered(button);
    EXPECT_TRUE(offered == 0 || offered == 6) << offered << " of 6";
    return offered == 6;
  }
  std::string said() { return user().beside("z +"); }
  std::vector<std::string> stops() {
    std::vector<std::string> all;
    for (const auto& message : world().hear<StringStamped>("needle/state_command").all())
      all.push_back(message->string);
    return all;
  }
  void expectLastMove(const Eigen::Vector3d& place) {
    ASSERT_FALSE(sent_.empty());
    const auto& move = sent_.back();
    EXPECT_EQ(move.header.frame_id, "world");
    EXPECT_LT((toVector(move.pose.position) - place).norm(), 1e-12);
    EXPECT_EQ(move.pose.orientation.w, 1);
  }

  static constexpr const char* kButtons[] = {"x -", "x +", "y -", "y +", "z -", "z +"};

  VirtualSession session_{{"hand.device:=none"}};
  ShownController controller_{session_, "{mode: manual}"};
  ConsoleBench bench_{session_, "calibrate"};
  Eigen::Vector3d tip_ = kTip;
  bool tip_known_ = true, busy_ = false;
  std::vector<geometry_msgs::PoseStamped> sent_;
  Subscription moves_;
};

TEST_F(ConsoleStepsTest, EachButtonMovesTheNeedleAlongItsAxis) {
  ASSERT_TRUE(allOffered()) << said();
  EXPECT_EQ(said(), "at 1.0, -2.0, 80.0 um");
  Eigen::Vector3d at = kTip;
  for (int i = 0; i < 6; ++i) {
    press(kButtons[i]);
    at[i / 2] += i % 2 ? 5e-6 : -5e-6;
    ASSERT_EQ(sent_.size(), static_cast<std::size_t>(i + 1)) << kButtons[i];
    expectLastMove(at);
  }
}

TEST_F(ConsoleStepsTest, StepsAddUpOnTheWayAndStopEndsIt) {
  press("z +");
  report(true);
  bench_.run(0.5);
  press("z +");
  press("z +");
  ASSERT_EQ(sent_.size(), 3u);
  expectLastMove(kTip + Eigen::Vector3d(0, 0, 15e-6));
  EXPECT_EQ(stops(), std::vector<std::string>());
  press("STOP");
  EXPECT_EQ(stops(), std::vector<std::string>{"stop"});
}

TEST_F(ConsoleStepsTest, StopOfANeedleThatRestsIsNotSentToIt) {
  press("STOP");
  EXPECT_EQ(stops(), std::vector<std::string>());
}

TEST_F(ConsoleStepsTest, TheNeedleIsTheControllersWhileThatLeadsIt) {
  controller_.change("ENABLED");
  ASSERT_TRUE(bench_.until([&] { return !allOffered(); }));
  EXPECT_EQ(said(), "ENABLED: press Disable first");
  press("x -");
  controller_.change("DISABLED");
  ASSERT_TRUE(bench_.until([&] { return allOffered(); }));
  EXPECT_EQ(sent_.size(), 0u);
}

TEST_F(ConsoleStepsTest, NoStepFromAPlaceThatIsNotKnown) {
  tip_known_ = false;
  ASSERT_TRUE(bench_.until([&] { return !allOffered(); }));
  EXPECT_EQ(said(), "the needle's position is not known");
  press("x -");
  EXPECT_EQ(sent_.size(), 0u);
}

TEST_F(ConsoleStepsTest, NoStepOfAMicromanipulatorThatIsDisabledOrGone) {
  report(false, "DISABLED");
  ASSERT_FALSE(allOffered());
  report(false);
  ASSERT_TRUE(allOffered());
  world().hangUp("needle/operating_state");  // a latched state outlives its node
  bench_.run(0.2);
  EXPECT_FALSE(allOffered());
  EXPECT_EQ(said(), "no node micromanipulator");
}

/// The test is a motor of the focus and a camera.
class FocusStepsTest : public testing::Test {
 protected:
  static constexpr int kWide = 64, kHigh = 48;  // px

  FocusStepsTest() {
    startQt();
    setParameters(session_, "/microscope", YAML::Load("{focus: {range: [-1.5e-6, 50e-6]}}"));
    session_.executive().add("rviz", [this](Bus& bus) {
      const auto microscope = std::make_shared<MicroscopeWidget>([this] { ++appeared_; });
      microscope->start(bus);
      bus.setStep(1e-3 * MicroscopeWidget::kPeriod, [widget = microscope.get()](const ros::Time&) { widget->tick(); });
      microscope_ = microscope.get();
      return microscope;
    });
    microscope_->resize(640, 400);
    microscope_->show();
    user_ = std::make_unique<WindowUser>(*microscope_);
    moves_ = world().bus().subscribe<sensor_msgs::JointState>("focus/move_jp", 10, [this](const auto& delivery) {
      steps_.push_back(focus_ = delivery.message->position.at(0));
    });
    world().repeat<sensor_msgs::JointState>("focus/measured_js", [this]() -> std::optional<sensor_msgs::JointState> {
      sensor_msgs::JointState message;
      message.name = {"focus"};
      message.position = {focus_};
      return message;
    });
    run(0.3);
  }

  TestNode& world() { return session_.world(); }
  void run(double seconds) {
    session_.run(seconds);
    QApplication::processEvents();
  }
  void showImages() {
    sensor_msgs::Image image;
    image.width = kWide;
    image.height = kHigh;
    image.encoding = "rgb8";
    image.step = 3 * kWide;
    image.data.assign(3 * kWide * kHigh, 200);
    world().repeat("microscope/image_raw", image);
    run(0.2);
  }
  void press(const std::string& button) {
    user_->click(button);
    run(0.2);
  }
  /// Notches of the wheel over the middle of the image; positive: away from the user.
  void turn(int notches, Qt::KeyboardModifiers keys) {
    QWidget& view = *user_->shown<MicroscopeView>().at(0);
    const QPointF place = view.rect().center();
    QWheelEvent event(place, view.mapToGlobal(place.toPoint()), {}, {0, 120 * notches}, Qt::NoButton, keys,
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(&view, &event);
    run(0.2);
  }
  void expectSteps(const std::vector<double>& places) {
    ASSERT_EQ(steps_.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(steps_[i], places[i], 1e-12) << i;
  }

  VirtualSession session_{{"hand.device:=none"}};
  MicroscopeWidget* microscope_ = nullptr;
  std::unique_ptr<WindowUser> user_;
  int appeared_ = 0;
  double focus_ = 0;  // m
  std::vector<double> steps_;
  Subscription moves_;
};

TEST_F(FocusStepsTest, ButtonsMoveTheFocusByOneStep) {
  ASSERT_TRUE(user_->offered("-") && user_->offered("+"));
  for (const char* button : {"+", "+", "-"}) press(button);
  expectSteps({1e-6, 2e-6, 1e-6});
}

TEST_F(FocusStepsTest, TheWheelMovesItWhileCtrlIsHeld) {
  showImages();
  EXPECT_EQ(appeared_, 1);
  turn(1, Qt::NoModifier);  // it magnifies
  turn(1, Qt::ControlModifier);
  turn(-1, Qt::ControlModifier);
  turn(-1, Qt::ControlModifier);
  expectSteps({1e-6, 0, -1e-6});
}

TEST_F(FocusStepsTest, NoStepLeavesTheRange) {
  press("-");
  run(1.5);
  EXPECT_FALSE(user_->offered("-"));
  EXPECT_TRUE(user_->offered("+"));
  press("-");
  expectSteps({-1e-6});
}

TEST_F(FocusStepsTest, NoneIsOfferedOfAMotorThatIsSilent) {
  world().silence("focus/measured_js");
  run(1.5);
  EXPECT_FALSE(user_->offered("-") || user_->offered("+"));
}

TEST_F(FocusStepsTest, TheImageAppearsWithTheFirstNodeThatPublishesOne) {
  EXPECT_EQ(appeared_, 0);
  showImages();
  EXPECT_EQ(appeared_, 1);
}

}  // namespace
}  // namespace microinjection
