#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/Image.h>

#include "cell_microinjection/GoToPixelAction.h"
#include "console_bench.h"
#include "rviz/microscope_view.h"
#include "rviz/pixel_goal_bar.h"
#include "scripted_action.h"

namespace microinjection {
namespace {

/// A click into the image proposes a place, and Go has the needle led there. The test is the controller, the camera,
/// and the node that leads the needle by images.
class PixelGoalTest : public testing::Test {
 protected:
  using Leading = ScriptedAction<cell_microinjection::GoToPixelAction>;
  static constexpr std::uint32_t kWide = 64, kHigh = 48;  // px
  static constexpr int kGrey = 200;
  static constexpr QRgb kImageColour = 0xff000000 | kGrey << 16 | kGrey << 8 | kGrey, kGoalMark = 0xffff50ff;

  PixelGoalTest() {
    startQt();
    session_.executive().add("rviz", [this](Bus& bus) {
      const auto microscope = std::make_shared<MicroscopeWidget>([] {});
      microscope->start(bus);
      bus.setStep(1e-3 * MicroscopeWidget::kPeriod, [widget = microscope.get()](const ros::Time&) { widget->tick(); });
      microscope_ = microscope.get();
      return microscope;
    });
    session_.executive().add("visual_servo", [this](Bus& bus) {
      return leading_ = std::make_shared<Leading>(bus, "visual_servo/go_to_pixel");
    });
    microscope_->resize(640, 460);
    microscope_->show();
    user_ = std::make_unique<WindowUser>(*microscope_);
    showImages(kWide);
    controller_.change("ENABLED");
    run(0.5);
  }
  ~PixelGoalTest() override { leading_.reset(); }

  TestNode& world() { return session_.world(); }
  void run(double seconds) {
    session_.run(seconds);
    QApplication::processEvents();
  }
  void showImages(std::uint32_t wide) {
    sensor_msgs::Image image;
    image.width = wide;
    image.height = kHigh;
    image.encoding = "mono8";
    image.step = wide;
    image.data.assign(wide * kHigh, kGrey);
    world().repeat("microscope/image_raw", image);
    run(0.2);
  }
  /// Into the middle of the image.
  void clickImage() {
    user_->click(user_->placeOf(view()));
    QApplication::processEvents();
    run(0.2);
  }
  void click(const std::string& button) {
    user_->click(button);
    run(0.3);
  }
  bool proposed() { return user_->offered("Cancel"); }
  MicroscopeView& view() { return *user_->shown<MicroscopeView>().at(0); }
  /// Of the image on the screen, in the window.
  QRect shownImage() {
    const QImage screen = view().grab().toImage();
    QRect seen;
    for (int y = 0; y < screen.height(); ++y) {
      for (int x = 0; x < screen.width(); ++x) {
        if (screen.pixel(x, y) == kImageColour) seen |= QRect(x, y, 1, 1);
      }
    }
    return seen.translated(view().mapTo(microscope_, QPoint(0, 0)));
  }
  int marked() {
    const QImage screen = view().grab().toImage();
    int count = 0;
    for (int y = 0; y < screen.height(); ++y) {
      for (int x = 0; x < screen.width(); ++x) count += screen.pixel(x, y) == kGoalMark;
    }
    return count;
  }

  VirtualSession session_{{"hand.device:=none"}};
  ShownController controller_{session_, "{mode: manual}"};
  std::shared_ptr<Leading> leading_;
  MicroscopeWidget* microscope_ = nullptr;
  std::unique_ptr<WindowUser> user_;
};

TEST_F(PixelGoalTest, TheNeedleIsLedThereAfterGo) {
  auto& proposals = world().hear<geometry_msgs::PointStamped>("visual_servo/proposed_pixel");
  EXPECT_FALSE(user_->offered("Go"));
  EXPECT_EQ(user_->beside("Go"), "click where the tip shall go");
  clickImage();
  ASSERT_TRUE(user_->offered("Go")) << user_->beside("Go");
  EXPECT_EQ(leading_->goals.size(), 0u) << "before it is confirmed";
  EXPECT_NEAR(proposals.newest()->point.x, 0.5 * (kWide - 1), 0.3);
  EXPECT_NEAR(proposals.newest()->point.y, 0.5 * (kHigh - 1), 0.3);
  leading_->feedback.distance = 12;
  leading_->feedback.waits_for = "an image";
  click("Go");
  ASSERT_EQ(leading_->goals.size(), 1u);
  EXPECT_NEAR(leading_->goals[0].x, 0.5 * (kWide - 1), 0.3);
  EXPECT_NEAR(leading_->goals[0].y, 0.5 * (kHigh - 1), 0.3);
  EXPECT_EQ(WindowUser::lampIn(*user_->shown<PixelGoalBar>().at(0)),
            std::pair(std::string("yellow"), std::string("12.0 px away, waits: an image")));
  click("Cancel");
  EXPECT_FALSE(leading_->active());
  EXPECT_FALSE(proposed());
  EXPECT_TRUE(proposals.newest()->header.stamp.isZero()) << "it is forgotten";
}

TEST_F(PixelGoalTest, APlaceIsThePixelThatIsSeenThere) {
  const QRect image = shownImage();
  EXPECT_EQ(marked(), 0);
  const QPoint place = image.topLeft() + QPoint(3 * image.width() / 10, 6 * image.height() / 10);
  user_->click(place);
  QApplication::processEvents();
  run(0.2);
  EXPECT_GT(marked(), 0);
  click("Go");
  ASSERT_EQ(leading_->goals.size(), 1u);
  EXPECT_NEAR(leading_->goals[0].x, kWide * (place.x() + 0.5 - image.left()) / image.width() - 0.5, 0.3);
  EXPECT_NEAR(leading_->goals[0].y, kHigh * (place.y() + 0.5 - image.top()) / image.height() - 0.5, 0.3);
}

TEST_F(PixelGoalTest, ADoubleClickProposesNothing) {
  user_->click(user_->placeOf(view()));
  QTest::mouseDClick(&view(), Qt::LeftButton, {}, view().rect().center());
  QApplication::processEvents();
  run(0.2);
  EXPECT_FALSE(proposed());
}

TEST_F(PixelGoalTest, APlaceIsForgottenWhenTheControllerLeavesEnabled) {
  clickImage();
  ASSERT_TRUE(proposed());
  controller_.change("PAUSED");
  run(0.2);
  EXPECT_FALSE(proposed());
  controller_.change("ENABLED");
  run(0.2);
  EXPECT_FALSE(proposed() || user_->offered("Go"));
}

TEST_F(PixelGoalTest, APlaceIsForgottenAfterAMinute) {
  clickImage();
  run(59);
  EXPECT_TRUE(proposed());
  run(2);
  EXPECT_FALSE(proposed());
}

TEST_F(PixelGoalTest, APlaceOfAnotherImageIsAnother) {
  clickImage();
  ASSERT_TRUE(proposed());
  showImages(2 * kWide);
  EXPECT_FALSE(proposed());
}

TEST_F(PixelGoalTest, APlaceIsForgottenWithTheImage) {
  clickImage();
  world().silence("microscope/image_raw");
  run(2.5);
  EXPECT_FALSE(proposed());
}

TEST_F(PixelGoalTest, TheWayEndsWithTheNodeThatLeads) {
  clickImage();
  click("Go");
  leading_.reset();
  session_.executive().kill("visual_servo");
  run(0.3);
  EXPECT_EQ(WindowUser::lampIn(*user_->shown<PixelGoalBar>().at(0)),
            std::pair(std::string("red"), std::string("visual_servo has ended")));
}

TEST_F(PixelGoalTest, NothingIsOfferedInAnotherModeOrOfASilentController) {
  clickImage();
  ASSERT_TRUE(user_->offered("Go"));
  session_.executive().freeze("injection_controller");
  run(1.2);
  EXPECT_FALSE(user_->offered("Go"));
  setParameters(session_, "/injection_controller", YAML::Load("{mode: automatic}"));
  session_.executive().thaw("injection_controller");
  run(0.3);
  EXPECT_EQ(user_->beside("Go"), "mode is automatic, must be manual");
}

}  // namespace
}  // namespace microinjection
