#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "operation/console/image_pairing.h"
#include "operation/console/image_view.h"
#include "operation/console/specimen_lines.h"

namespace microinjection {
namespace {

using Eigen::Vector2d;
using Verdict = FindingView::Verdict;

ImageView viewOf(int widget_width, int widget_height) {
  ImageView view;
  view.setWidget(widget_width, widget_height);
  view.setImage(1392, 1040);
  return view;
}

TEST(ImageView, ShowsTheWholeImageInTheMiddle) {
  const ImageView view = viewOf(696, 600);
  EXPECT_DOUBLE_EQ(view.scale(), 0.5);
  // Half a pixel beside the centre of the first one; 40 px are left above and below.
  EXPECT_TRUE(view.toWidget({-0.5, -0.5}).isApprox(Vector2d(0, 40)));
  EXPECT_TRUE(view.toWidget({1391.5, 1039.5}).isApprox(Vector2d(696, 560)));
  EXPECT_TRUE(view.showsAll());
}

TEST(ImageView, FindsThePixelUnderAPlace) {
  ImageView view = viewOf(640, 340);
  view.showSquare({700, 500}, 400);
  view.zoom({100, 50}, 1.7);
  for (const Vector2d& pixel : {Vector2d(0, 0), Vector2d(700.5, 499.25)}) {
    EXPECT_TRUE(view.toImage(view.toWidget(pixel)).isApprox(pixel, 1e-9));
  }
}

TEST(ImageView, KeepsThePixelUnderThePointerWhileItZooms) {
  ImageView view = viewOf(640, 340);
  view.showSquare({700, 500}, 400);
  const Vector2d place(320, 170), pixel = view.toImage(place);
  view.zoom(place, 1.5);
  EXPECT_TRUE(view.toImage(place).isApprox(pixel, 1e-9));
  EXPECT_NEAR(view.scale(), 1.5 * 340 / 400, 1e-12);
}

TEST(ImageView, NeverLosesTheImage) {
  ImageView view = viewOf(640, 340);
  view.showSquare({0, 0}, 200);
  EXPECT_LT(view.toWidget({-0.5, -0.5}).norm(), 1e-6);
  view.pan({-1e6, -1e6});
  EXPECT_LT((view.toWidget({1391.5, 1039.5}) - Vector2d(640, 340)).norm(), 1e-6);
  view.zoom({0, 0}, 1e-9);
  EXPECT_TRUE(view.showsAll());
  view.zoom({0, 0}, 1e9);
  EXPECT_DOUBLE_EQ(view.scale(), ImageView::kLargestScale);
}

TEST(ImageView, StaysWholeWhenTheWidgetGrows) {
  ImageView view = viewOf(696, 520);
  view.setWidget(1392, 1040);
  EXPECT_DOUBLE_EQ(view.scale(), 1);
  view.showSquare({700, 500}, 520);
  view.setWidget(1000, 900);
  EXPECT_DOUBLE_EQ(view.scale(), 2);
  view.setImage(640, 480);
  EXPECT_TRUE(view.showsAll());
}

TEST(ImageView, KnowsWhatIsBesideTheImage) {
  const ImageView view = viewOf(640, 340);
  EXPECT_TRUE(view.contains({0, 1039}));
  EXPECT_FALSE(view.contains({-1, 500}));
  EXPECT_FALSE(view.contains({500, 1040}));
}

TEST(ImagePairing, ShowsTheImageOfTheNewestFinding) {
  ImagePairing<int> pairing;
  EXPECT_FALSE(pairing.shown(0));
  for (int i = 0; i < 5; ++i) pairing.addImage(10 + 0.033 * i, i, 0.033 * i);
  EXPECT_EQ(pairing.shown(0.14), 4);
  pairing.addFinding(10 + 0.033 * 2, 0.14);
  EXPECT_EQ(pairing.shown(0.15), 2);
  EXPECT_TRUE(pairing.hasFinding(0.15));
  // Vision is silent: the newest image is better than an old one with a finding.
  EXPECT_EQ(pairing.shown(0.15 + ImagePairing<int>::kFresh), 4);
  EXPECT_FALSE(pairing.hasFinding(0.15 + ImagePairing<int>::kFresh));
}

TEST(ImagePairing, TakesTheNearestWhereTheImageItselfWasLost) {
  ImagePairing<int> pairing;
  pairing.addImage(1.0, 1, 0);
  pairing.addImage(1.2, 2, 0.2);
  pairing.addFinding(1.15, 0.2);
  EXPECT_EQ(pairing.shown(0.2), 2);
}

TEST(ImagePairing, ForgetsImagesBeforeAJumpBackAndKeepsFew) {
  ImagePairing<int> pairing;
  pairing.addImage(100, 1, 0);
  pairing.addImage(5, 2, 0.1);
  pairing.addFinding(100, 0.1);
  EXPECT_EQ(pairing.shown(0.1), 2);
  for (int i = 0; i < 100; ++i) pairing.addImage(6 + i, i, i);
  pairing.addFinding(6, 99);
  EXPECT_EQ(pairing.shown(99), 100 - static_cast<int>(ImagePairing<int>::kImages));
  EXPECT_DOUBLE_EQ(pairing.age(99.5), 0.5);
}

TEST(SpecimenLines, HaveVerdictReasonAndLength) {
  const FindingView found{Verdict::kFound, ""}, missing{Verdict::kNotFound, "no outline"};
  EXPECT_EQ(findingLine("Needle", found).text, "Needle: found");
  EXPECT_EQ(findingLine("Needle", missing).text, "Needle: not found: no outline");
  EXPECT_EQ(findingLine("Needle", missing).light, Light::kGrey);
  EXPECT_EQ(findingLine("Cell", found, "diameter", 224, 0.8, 0.25e-6).text, "Cell: found, diameter 56.0 +- 0.20 um");
  EXPECT_EQ(findingLine("Cell", found, "diameter", 224, 0.8, 0).text, "Cell: found, diameter 224.0 +- 0.8 px");
  const FindingView doubtful{Verdict::kUncertain, "faint"};
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(findingLine("Cell", doubtful, "diameter", 224, none, 0).text, "Cell: uncertain: faint");
  EXPECT_EQ(findingLine("Cell", doubtful, "diameter", 224, 1, 0).light, Light::kYellow);
}

TEST(SpecimenLines, AScaleBarIsARoundLength) {
  EXPECT_NEAR(scaleBar(87e-6), 50e-6, 1e-12);
  EXPECT_NEAR(scaleBar(49e-6), 20e-6, 1e-12);
  EXPECT_NEAR(scaleBar(1.9e-6), 1e-6, 1e-12);
  EXPECT_EQ(scaleBar(0), 0);
  EXPECT_EQ(scaleBar(std::numeric_limits<double>::infinity()), 0);
}

}  // namespace
}  // namespace microinjection
