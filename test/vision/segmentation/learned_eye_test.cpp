#include "vision/segmentation/learned_eye.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

/// Draws classes in a frame of 1024 x 768, of which an output pixel is a square of 8 px.
class DrawnClasses {
 public:
  DrawnClasses() : classes_(kSize, CV_8U, cv::Scalar(0)) {}

  void disc(PixelClass what, const cv::Point& centre, int radius) {
    cv::circle(classes_, centre, radius, static_cast<int>(what), cv::FILLED);
  }
  void polygon(PixelClass what, const std::vector<cv::Point>& corners) {
    cv::fillConvexPoly(classes_, corners, static_cast<int>(what));
  }
  void oocyte(const cv::Point& centre, int ooplasm, int zona, int outer) {
    disc(PixelClass::kZona, centre, outer);
    disc(PixelClass::kPerivitellineSpace, centre, zona);
    disc(PixelClass::kOoplasm, centre, ooplasm);
  }
  Proposal proposal() const {
    std::array<cv::Mat, kPixelClasses> planes;
    for (std::size_t i = 0; i < kPixelClasses; ++i) {
      cv::Mat plane;
      cv::Mat(classes_ == static_cast<int>(i)).convertTo(plane, CV_32F, 1 / 255.0);
      cv::resize(plane, planes[i], {Segmentation::kWidth, Segmentation::kHeight}, 0, 0, cv::INTER_AREA);
    }
    return LearnedEye::proposalOf(Segmentation(planes, WorkingImage(cv::Mat(kSize, CV_32F, 0.5F)), kSize));
  }

 private:
  static constexpr int kWidth = 1024, kHeight = 768;
  const cv::Size kSize{kWidth, kHeight};
  cv::Mat classes_;
};

TEST(LearnedEye, ProposesAHeldOocyte) {
  DrawnClasses drawn;
  drawn.oocyte({500, 400}, 150, 165, 200);
  drawn.disc(PixelClass::kOoplasm, {850, 120}, 60);  // another cell
  drawn.polygon(PixelClass::kHoldingPipette, {{0, 330}, {290, 330}, {290, 470}, {0, 470}});
  drawn.polygon(PixelClass::kInjectionPipette, {{720, 396}, {1023, 300}, {1023, 380}});
  const Proposal proposal = drawn.proposal();
  ASSERT_EQ(proposal.cells.size(), 2U);
  const ProposedCell& cell = proposal.cells.front();
  EXPECT_TRUE(cell.held);
  EXPECT_NEAR(cell.ooplasm.meanDiameter(), 300, 8);
  ASSERT_TRUE(cell.zona);
  EXPECT_NEAR(cell.zona->meanDiameter(), 400, 10);
  EXPECT_LT(cv::norm(cell.zona->centre - cv::Point2d(500, 400)), 5);
  EXPECT_FALSE(proposal.cells[1].held);
  EXPECT_FALSE(proposal.cells[1].zona);
  ASSERT_TRUE(proposal.holding && proposal.injection);
  EXPECT_LT(cv::norm(proposal.holding->end - cv::Point2d(290, 400)), 12);
  EXPECT_NEAR(std::remainder(proposal.holding->direction() - M_PI, 2 * M_PI), 0, 0.05);
  EXPECT_NEAR(proposal.holding->half_width, 70, 8);
  EXPECT_LT(cv::norm(proposal.injection->end - cv::Point2d(720, 396)), 36);
  EXPECT_NEAR(proposal.injection->direction(), std::atan2(340.0 - 396, 1023 - 720), 0.1);
}

TEST(LearnedEye, ProposesNoPipetteThatDoesNotEnterAndNoCellThatIsABubble) {
  DrawnClasses drawn;
  drawn.polygon(PixelClass::kInjectionPipette, {{300, 300}, {500, 290}, {500, 310}});
  drawn.disc(PixelClass::kBubble, {700, 500}, 100);
  const Proposal proposal = drawn.proposal();
  EXPECT_TRUE(proposal.cells.empty());
  EXPECT_FALSE(proposal.injection || proposal.holding);
}

TEST(LearnedEye, SeesNoZonaWhereAPartOfOneIsSeen) {
  DrawnClasses drawn;
  drawn.oocyte({500, 400}, 150, 150, 200);
  drawn.polygon(PixelClass::kBackground, {{480, 0}, {1023, 0}, {1023, 767}, {480, 767}});
  drawn.disc(PixelClass::kOoplasm, {500, 400}, 150);
  ASSERT_EQ(drawn.proposal().cells.size(), 1U);
  EXPECT_FALSE(drawn.proposal().cells.front().zona);
}

/// With the weights that are built in.
TEST(LearnedEye, SeesWhatTheVirtualMicroscopeShows) {
  MicroscopeConfig config;
  config.camera.pixel_size = 0.3e-6;
  Microscope microscope(config);
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({0, 0}, 38e-6, 9e-6, 0));
  HoldingPipette holder;
  holder.mouth = {0, -37e-6};
  holder.inner_radius = 13.6e-6;
  scene.holding = holder;
  LearnedEye eye;
  const Proposal proposal = eye.propose(Frame(microscope.render(scene, 0, 3)));
  ASSERT_EQ(proposal.cells.size(), 1U);
  EXPECT_TRUE(proposal.cells[0].held);
  EXPECT_NEAR(proposal.cells[0].ooplasm.meanDiameter() * config.camera.pixel_size, 58e-6, 6e-6);
  ASSERT_TRUE(proposal.holding);
  const Eigen::Vector2d mouth = config.camera.pixelOf({0, -37e-6});
  EXPECT_LT(cv::norm(proposal.holding->end - cv::Point2d(mouth.x(), mouth.y())), 30);
  EXPECT_FALSE(proposal.injection);
}

}  // namespace
}  // namespace microinjection
