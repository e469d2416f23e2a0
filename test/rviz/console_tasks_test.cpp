#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include "cell_microinjection/CalibrateAction.h"
#include "cell_microinjection/CalibrateForce.h"
#include "cell_microinjection/DisplayView.h"
#include "cell_microinjection/FindFocusAction.h"
#include "cell_microinjection/MeasureCell.h"
#include "cell_microinjection/VisionState.h"
#include "console_bench.h"
#include "rviz/calibration_box.h"
#include "rviz/number_field.h"
#include "rviz/sensor_box.h"
#include "rviz/view_row.h"
#include "scripted_action.h"

namespace microinjection {
namespace {

using Lit = std::pair<std::string, std::string>;  // colour and text of a lamp

/// The tasks before an injection. The test is all nodes.
class ConsoleTasksTest : public testing::Test {
 protected:
  using Focus = ScriptedAction<cell_microinjection::FindFocusAction>;
  using Calibration = ScriptedAction<cell_microinjection::CalibrateAction>;

  ConsoleTasksTest() {
    session_.executive().add("focus", [this](Bus& bus) { return focus_ = std::make_shared<Focus>(bus, "focus/find"); });
    session_.executive().add("calibration", [this](Bus& bus) {
      return calibration_ = std::make_shared<Calibration>(bus, "calibration/calibrate");
    });
    bench_.run(0.5);
  }
  ~ConsoleTasksTest() override {
    focus_.reset();
    calibration_.reset();
  }

  WindowUser& user() { return bench_.user(); }
  TestNode& world() { return session_.world(); }
  void click(const std::string& button, std::size_t number = 0) {
    user().click(button, number);
    bench_.run(0.3);
  }
  Lit report() { return WindowUser::lampIn(*user().shown<CalibrationBox>().at(0)); }
  Lit sensor() { return WindowUser::lampIn(*user().shown<SensorBox>().at(0)); }
  /// The button Undo of the sensor stands above that of the calibration.
  static constexpr std::size_t kUndoOfCalibration = 1;

  BusHandle offerTrigger(const std::string& service, bool success, const std::string& message) {
    return world().bus().advertiseService<std_srvs::Trigger>(service, [=](auto&, auto& answer) {
      called_.push_back(service);
      answer.success = static_cast<unsigned char>(success);
      answer.message = message;
      return true;
    });
  }
  /// The force sensor's report, ten times a second.
  void reportSensor(const std::string& outcome, int points) {
    world().repeat<diagnostic_msgs::DiagnosticArray>("/diagnostics", [outcome, points] {
      diagnostic_msgs::DiagnosticStatus status;
      status.name = "force_sensor: sensor";
      status.values.resize(2);
      status.values[0].key = "tare and calibration";
      status.values[0].value = outcome;
      status.values[1].key = "calibration points";
      status.values[1].value = std::to_string(points);
      diagnostic_msgs::DiagnosticArray message;
      message.status = {status};
      return std::optional(message);
    });
    bench_.run(0.3);
  }

  VirtualSession session_{{"hand.device:=none"}};
  ShownController controller_{session_, "{mode: manual}"};
  ConsoleBench bench_{session_, "calibrate"};
  std::shared_ptr<Focus> focus_;
  std::shared_ptr<Calibration> calibration_;
  std::vector<std::string> called_;
};

TEST_F(ConsoleTasksTest, AnActionHasProgressAndAnOutcome) {
  ASSERT_TRUE(user().offered("Focus")) << user().beside("Focus");
  EXPECT_EQ(user().beside("Touch"), "no node touch: start the session with camera:=");
  EXPECT_FALSE(user().offered("Cancel"));
  click("Focus");
  ASSERT_EQ(focus_->goals.size(), 1u);
  focus_->feedback.plane = 3;
  focus_->feedback.planes = 17;
  bench_.run(0.2);
  EXPECT_EQ(report(), Lit("yellow", "Focus: plane 3 of 17"));
  EXPECT_EQ(user().beside("Calibrate"), "Focus is under way");
  cell_microinjection::FindFocusResult result;
  result.success = true;
  result.message = "the tip is sharp at 3.0 um";
  focus_->succeed(result);
  bench_.run(0.2);
  EXPECT_EQ(report(), Lit("green", "Focus: the tip is sharp at 3.0 um"));
  EXPECT_TRUE(user().offered("Calibrate"));
}

TEST_F(ConsoleTasksTest, CancelEndsTheTaskUnderWay) {
  focus_->when_cancelled.message = "cancelled";
  click("Focus");
  ASSERT_TRUE(user().offered("Cancel"));
  click("Cancel");
  EXPECT_FALSE(focus_->active());
  EXPECT_EQ(report(), Lit("red", "Focus: cancelled"));
}

/// Also one that somebody else has started: it would move the needle on.
TEST_F(ConsoleTasksTest, StopEndsACalibration) {
  click("Calibrate");
  ASSERT_TRUE(calibration_->active());
  click("STOP");
  EXPECT_FALSE(calibration_->active());
  EXPECT_EQ(report().first, "red");
}

TEST_F(ConsoleTasksTest, AResultWithoutWordsHasThoseOfItsState) {
  click("Focus");
  focus_->abort({}, "no image");
  bench_.run(0.2);
  EXPECT_EQ(report(), Lit("red", "Focus: ABORTED no image"));
}

TEST_F(ConsoleTasksTest, ServicesAreCalledWithWhatTheySay) {
  const BusHandle rezero = offerTrigger("/calibration/rezero", true, "the tip is at (3, 4) px");
  const BusHandle undo = offerTrigger("/calibration/undo", false, "there is none before");
  click("Re-zero");
  EXPECT_EQ(report(), Lit("green", "Re-zero: the tip is at (3, 4) px"));
  click("Undo", kUndoOfCalibration);
  EXPECT_EQ(report(), Lit("red", "Undo: there is none before"));
  EXPECT_EQ(called_, (std::vector<std::string>{"/calibration/rezero", "/calibration/undo"}));
}

TEST_F(ConsoleTasksTest, AServiceThatIsGoneDoesNotAnswer) {
  click("Re-zero");
  EXPECT_EQ(report(), Lit("red", "Re-zero: /calibration/rezero does not answer"));
}

TEST_F(ConsoleTasksTest, AMeasuredCellIsServed) {
  EXPECT_FALSE(user().offered("Measure"));
  world().say("vision/state", cell_microinjection::VisionState());
  bool serve = false;
  const BusHandle measure = world().bus().advertiseService<cell_microinjection::MeasureCell>(
      "/vision/measure_cell", [&](auto& request, auto& answer) {
        serve = request.serve;
        answer.success = true;
        answer.message = "80 um";
        return true;
      });
  bench_.run(0.2);
  click("Measure");
  EXPECT_TRUE(serve);
  EXPECT_EQ(report(), Lit("green", "Measure: 80 um"));
}

TEST_F(ConsoleTasksTest, TheSensorIsTaredAndCalibrated) {
  using Request = cell_microinjection::CalibrateForce::Request;
  EXPECT_FALSE(user().offered("Tare"));
  reportSensor("", 0);
  const BusHandle tare = offerTrigger("/force_sensor/tare", false, "the tip is in contact");
  std::vector<Request> requests;
  const BusHandle calibrate = world().bus().advertiseService<cell_microinjection::CalibrateForce>(
      "/force_sensor/calibrate", [&](auto& request, auto& answer) {
        requests.push_back(request);
        answer.success = true;
        return true;
      });
  click("Tare");
  EXPECT_EQ(called_, std::vector<std::string>{"/force_sensor/tare"});
  EXPECT_EQ(sensor(), Lit("red", "the tip is in contact"));
  const auto fields = user().shown<NumberField>();
  ASSERT_EQ(fields.size(), 2u);
  fields[0]->setValue(12.5);
  fields[1]->setValue(-3);
  click("Point");
  EXPECT_FALSE(user().offered("Gain"));
  reportSensor("averaged", 1);
  EXPECT_EQ(sensor(), Lit("green", "averaged"));
  click("Gain");
  click("Undo");
  ASSERT_EQ(requests.size(), 3u);
  EXPECT_EQ(requests[0].action, Request::ADD);
  EXPECT_NEAR(requests[0].force.z, 12.5e-6, 1e-12);
  EXPECT_NEAR(requests[0].force.x, -3e-6, 1e-12);
  EXPECT_EQ(requests[1].action, Request::SOLVE);
  EXPECT_EQ(requests[2].action, Request::UNDO);
  world().silence("/diagnostics");
  bench_.run(4);
  EXPECT_FALSE(user().offered("Tare"));
}

/// The console of an injection shows what the display reports, and sends what the operator chooses.
TEST(ConsoleView, FollowsTheDisplayAndLeadsIt) {
  VirtualSession session({"hand.device:=none"});
  ConsoleBench bench(session, "inject");
  auto& sent = session.world().hear<cell_microinjection::DisplayView>("viz/set_view");
  ViewRow& row = *bench.user().shown<ViewRow>().at(0);
  EXPECT_FALSE(row.isEnabled());
  cell_microinjection::DisplayView view;
  view.colour = "pressure";
  view.section = false;
  session.world().say("viz/view", view, true);
  bench.run(0.1);
  ASSERT_TRUE(row.isEnabled());
  EXPECT_EQ(row.findChild<QComboBox*>()->currentText(), "pressure");
  EXPECT_EQ(sent.count(), 0u) << "what the display reports must not be sent back to it";
  row.findChild<QCheckBox*>()->click();
  bench.run(0.1);
  ASSERT_EQ(sent.count(), 1u);
  EXPECT_EQ(sent.newest()->colour, "pressure");
  EXPECT_TRUE(sent.newest()->section);
}

TEST(ConsoleScore, RefusesAReferenceThatIsNoNumber) {
  VirtualSession session({"hand.device:=none"});
  setParameters(session, "/session_recorder/training", YAML::Load("{trainee: Ada, task: {peak_force: much}}"));
  ConsoleBench bench(session, "train");
  const auto says = [&](const QString& words) {
    for (const ElidedLabel* text : bench.user().shown<ElidedLabel>()) {
      if (text->toolTip().contains(words)) return true;
    }
    return false;
  };
  EXPECT_TRUE(says("peak_force"));
  EXPECT_FALSE(says("Ada"));
}

}  // namespace
}  // namespace microinjection
