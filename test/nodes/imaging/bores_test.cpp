#include <gtest/gtest.h>

#include <limits>

#include "cell_microinjection/BoreState.h"
#include "cell_microinjection/CellHold.h"
#include "cell_microinjection/InterfacePosition.h"
#include "placed_specimen.h"

namespace microinjection {
namespace {

/// The virtual microscope shows what the test says that both pipettes have drawn in, and vision measures it.
class BoresTest : public testing::Test {
 protected:
  static constexpr double kRate = 5, kHeldRadius = 30e-6;  // Hz, m
  using VisionState = cell_microinjection::VisionState;

  BoresTest() {
    session_.add("vision", "{pixel_size: 0.25e-6}");
    session_.add("microscope", camera_.parameters(kRate,
                                                  "needle: measured, specimen: {injection_pipette: {tip_radius: "
                                                  "2.5e-6, shaft_radius: 10.0e-6}, dust: 0}"));
    session_.world().hear<VisionState>("/vision/state");
    session_.world().hear<cell_microinjection::InterfacePosition>("/needle/interface");
    TestNode& node = session_.addTestNode("bores", 0.02);
    node.repeat<cell_microinjection::BoreState>("/cell/bore", [this] { return bore_; });
    node.repeat<cell_microinjection::CellHold>("/cell/hold", [this] { return hold_; });
  }

  void drawIntoNeedle(double length) {
    bore_.emplace();
    bore_->covered = true;
    bore_->length = length;
    bore_->tension = 1e-3;
  }
  /// What vision says of ten images from now on, at last.
  VisionState seen() {
    session_.world().hear<VisionState>("/vision/state").clear();
    session_.world().hear<cell_microinjection::InterfacePosition>("/needle/interface").clear();
    session_.run(2);
    const auto* state = session_.world().hear<VisionState>("/vision/state").newest();
    return state ? *state : VisionState();
  }
  void placeCell(double height) {
    geometry_msgs::TransformStamped frame;
    frame.header.stamp = session_.now();
    frame.header.frame_id = "world";
    frame.child_frame_id = "cell";
    frame.transform.translation.z = height;
    frame.transform.rotation.w = 1;
    tf2_msgs::TFMessage message;
    message.transforms = {frame};
    session_.world().say("/tf_static", message, true);
  }

  SmallCamera camera_{480, 700, {239.5, 459.5}};
  VirtualSession session_{{"camera.source:=sim", "hand.device:=none"}};
  PlacedSpecimen specimen_{session_, kHeldRadius, {20e-6, 0, 60e-6}};
  std::optional<cell_microinjection::BoreState> bore_;
  std::optional<cell_microinjection::CellHold> hold_;
};

TEST_F(BoresTest, TheInterfaceInTheNeedleIsPublishedAtTheImagesStamp) {
  auto& interfaces = session_.world().hear<cell_microinjection::InterfacePosition>("/needle/interface");
  EXPECT_NE(seen().needle_bore.verdict, cell_microinjection::BoreInImage::FOUND);
  EXPECT_EQ(interfaces.count(), 0u);  // the bore is empty
  for (const double length : {8e-6, 11e-6}) {
    drawIntoNeedle(length);
    const VisionState state = seen();
    ASSERT_EQ(state.needle_bore.verdict, cell_microinjection::BoreInImage::FOUND)
        << state.needle_bore.reason << "; tip: " << state.injection_pipette.reason;
    ASSERT_TRUE(interfaces.newest());
    EXPECT_EQ(interfaces.newest()->header.stamp, state.header.stamp);
    EXPECT_NEAR(interfaces.newest()->position, length, 0.3e-6);
  }
  bore_.reset();  // stale: the needle is drawn empty
  seen();
  EXPECT_NE(seen().needle_bore.verdict, cell_microinjection::BoreInImage::FOUND);
}

TEST_F(BoresTest, TheTongueOfAHeldCellIsMeasured) {
  hold_.emplace();
  hold_->orientation.w = 1;
  hold_->tongue = 9e-6;
  hold_->limit = std::numeric_limits<double>::infinity();
  const VisionState state = seen();
  EXPECT_TRUE(state.hold.held) << state.hold.reason << ", gap " << state.hold.gap << "; cell: " << state.cell.reason
                               << "; mouth: " << state.holding_pipette.reason;
  ASSERT_NE(state.holder_bore.verdict, cell_microinjection::BoreInImage::NOT_FOUND) << state.holder_bore.reason;
  EXPECT_NEAR(state.holder_bore.length * camera_.pixel, hold_->tongue, 0.4e-6);
}

TEST_F(BoresTest, ACellThatLeftTheMouthIsDrawnElsewhereAndSeenLost) {
  const VisionState before = seen();
  ASSERT_TRUE(cellIsFound(&before));
  EXPECT_TRUE(before.hold.held);
  placeCell(8e-6);
  const VisionState after = seen();
  ASSERT_TRUE(cellIsFound(&after));
  EXPECT_NEAR(before.cell.y - after.cell.y, 8e-6 / camera_.pixel, 1);
  EXPECT_EQ(after.hold.verdict, cell_microinjection::HoldInImage::FOUND) << after.hold.reason;
  EXPECT_FALSE(after.hold.held);
  placeCell(500e-6);  // out of the view
  const VisionState gone = seen();
  EXPECT_FALSE(cellIsFound(&gone));
  EXPECT_NE(gone.hold.verdict, cell_microinjection::HoldInImage::FOUND);
}

}  // namespace
}  // namespace microinjection
