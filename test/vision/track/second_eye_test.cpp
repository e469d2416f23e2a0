#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "vision/microscope/microscope.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {
namespace {

constexpr double kSeenPixel = 0.3e-6, kSeenRadius = 38e-6;  // m
constexpr double kSeenTurn = 0.7;                           // rad, of the needle from the vertical

/// Sees what it is told.
class ToldEye : public SecondEye {
 public:
  Proposal propose(const Frame&) override {
    ++looks;
    return proposal;
  }
  ProposedPipette lookCloser(const Frame&, const std::string&, const ProposedPipette& pipette) override {
    return pipette;
  }

  Proposal proposal;
  int looks = 0;
};

/// A held oocyte with a zona and a needle that comes from no usual side, and an eye that is right.
class SecondEyeTest : public testing::Test {
 protected:
  SecondEyeTest() : microscope_(microscopeConfig()), eye_(std::make_shared<ToldEye>()) {
    scene_.cells.push_back(CellScene::round({0, 0}, kSeenRadius, 6e-6, 0));
    HoldingPipette holder;
    holder.mouth = {0, -37e-6};
    holder.inner_radius = 13.6e-6;
    scene_.holding = holder;
    InjectionPipette needle;
    needle.tip = {45e-6, 0, 40e-6};
    needle.axis = {std::sin(kSeenTurn), 0, std::cos(kSeenTurn)};
    needle.tip_radius = 3e-6;
    scene_.injection = needle;
    const double radius = kSeenRadius / kSeenPixel, ooplasm = (kSeenRadius - 6e-6) / kSeenPixel;
    eye_->proposal.cells.push_back({{pixel(0, 0) + cv::Point2d(3, -2), {1.02 * ooplasm, 0.99 * ooplasm}, 0.3},
                                    Ellipse{pixel(0, 0) + cv::Point2d(-2, 4), {1.03 * radius, 1.01 * radius}, 0.1},
                                    false,
                                    true});
    eye_->proposal.injection = ProposedPipette{pixel(45e-6, 40e-6) + cv::Point2d(7, 5), pixel(110e-6, 117e-6), 15, 20};
    eye_->proposal.holding = ProposedPipette{pixel(0, -37e-6) + cv::Point2d(-6, 3), pixel(0, -140e-6), 100, 20};
  }

  static MicroscopeConfig microscopeConfig() {
    MicroscopeConfig config;
    config.camera.pixel_size = kSeenPixel;
    return config;
  }
  cv::Point2d pixel(double x, double z) const {
    const Eigen::Vector2d place = microscope_.config().camera.pixelOf({x, z});
    return {place.x(), place.y()};
  }
  Frame frame() { return Frame(microscope_.render(scene_, 0, ++seed_)); }
  SpecimenView seen(const SpecimenTrackerConfig& config) { return SpecimenTracker(config, eye_).next(frame()); }
  static SpecimenTrackerConfig anyDirection() {
    ConfigReader nothing(YAML::Node(YAML::NodeType::Map), "");
    return SpecimenTrackerConfig::read(nothing);
  }

  Microscope microscope_;
  MicroscopeScene scene_;
  std::shared_ptr<ToldEye> eye_;
  std::uint64_t seed_ = 0;
};

TEST_F(SecondEyeTest, WhatBothSeeIsFound) {
  const SpecimenView view = seen(anyDirection());
  ASSERT_TRUE(view.cell.size.isFound()) << view.cell.size.reason;
  EXPECT_LT(cv::norm(view.cell.centre - pixel(0, 0)), 0.3);
  EXPECT_NEAR(view.cell.outer().ellipse.meanDiameter() * kSeenPixel, 2 * kSeenRadius, 0.01 * kSeenRadius);
  ASSERT_TRUE(view.injection.finding.isFound()) << view.injection.finding.reason;
  EXPECT_LT(cv::norm(view.injection.end - pixel(45e-6, 40e-6)), 0.5);
  ASSERT_TRUE(view.holding.finding.isFound()) << view.holding.finding.reason;
  EXPECT_LT(cv::norm(view.holding.end - pixel(0, -37e-6)), 1);
  EXPECT_LT(view.holding.deviationAlong(), 0.2) << "it is sure by its own lips, and as exact as they are";
}

TEST_F(SecondEyeTest, WhatItDoesNotSeeIsNotClaimed) {
  eye_->proposal.cells.clear();
  eye_->proposal.injection.reset();
  eye_->proposal.holding.reset();
  const SpecimenView view = seen(anyDirection());
  EXPECT_FALSE(view.cell.finding.hasValues());
  EXPECT_FALSE(view.injection.finding.hasValues());
  EXPECT_FALSE(view.holding.finding.hasValues());
  EXPECT_EQ(eye_->looks, 1);
}

TEST_F(SecondEyeTest, ACellThatItSeesOtherwiseIsUncertain) {
  const ProposedCell right = eye_->proposal.cells.front();
  ProposedCell& told = eye_->proposal.cells.front();
  told.zona->semi_axes *= 1.15;
  EXPECT_EQ(seen(anyDirection()).cell.size.reason, "a network sees the zona's border elsewhere");
  told = right;
  told.zona.reset();
  told.ooplasm.semi_axes *= 0.8;
  const CellDetection cell = seen(anyDirection()).cell;
  EXPECT_EQ(cell.size.reason, "a network sees the cell's border elsewhere");
  EXPECT_EQ(cell.finding.verdict, Verdict::kUncertain);
}

/// A zona that the network overlooks is no less sure; one that was not measured is.
TEST_F(SecondEyeTest, AThinZonaMayBeOverlooked) {
  eye_->proposal.cells.front().zona.reset();
  EXPECT_TRUE(seen(anyDirection()).cell.second->isFound());
  scene_.cells.front() = CellScene::round({0, 0}, kSeenRadius - 6e-6, 0, 0);
  EXPECT_TRUE(seen(anyDirection()).cell.second->isFound());
  eye_->proposal.cells.front().zona = Ellipse{pixel(0, 0), {127, 127}, 0};
  EXPECT_FALSE(seen(anyDirection()).cell.size.isFound());
}

/// Each frame that follows has the doubt of the one that was searched.
TEST_F(SecondEyeTest, ADoubtIsTracked) {
  eye_->proposal.cells.front().zona->semi_axes *= 1.15;
  eye_->proposal.injection->end += cv::Point2d(-24, 28);  // before the tip
  SpecimenTracker tracker(anyDirection(), eye_);
  for (int i = 0; i < SearchPace::kFirst + 4; ++i) {
    const SpecimenView& view = tracker.next(frame());
    EXPECT_EQ(view.cell.size.reason, "a network sees the zona's border elsewhere") << i;
    EXPECT_EQ(view.injection.finding.reason, "a network sees its end elsewhere") << i;
  }
}

/// Another one beside it would be taken for the cell.
TEST_F(SecondEyeTest, AHeldCellThatCannotBeMeasuredIsNotReplaced) {
  scene_.cells.front() = CellScene::round({0, 70e-6}, 25e-6, 0, 0);
  scene_.injection.reset();
  ProposedCell beside = eye_->proposal.cells.front();
  beside.zona.reset();
  beside.held = false;
  beside.ooplasm = {pixel(0, 70e-6), {83, 83}, 0};
  eye_->proposal.cells.push_back(beside);
  EXPECT_FALSE(seen(anyDirection()).cell.finding.hasValues());
  eye_->proposal.cells.erase(eye_->proposal.cells.begin());
  EXPECT_TRUE(seen(anyDirection()).cell.finding.hasValues());
}

TEST_F(SecondEyeTest, OfTwoCellsThatWhichIsHeldIsTheCell) {
  ProposedCell beside = eye_->proposal.cells.front();
  beside.ooplasm.centre += cv::Point2d(-400, 0);
  beside.zona->centre += cv::Point2d(-400, 0);
  beside.held = false;
  eye_->proposal.cells.push_back(beside);
  EXPECT_TRUE(seen(anyDirection()).cell.size.isFound());
  eye_->proposal.cells.front().held = false;
  EXPECT_EQ(seen(anyDirection()).cell.size.reason, CellDetection::kTwoCells);
}

TEST_F(SecondEyeTest, APipetteElsewhereIsUncertainOrNone) {
  eye_->proposal.injection->end += cv::Point2d(60, -71);  // along its axis
  eye_->proposal.injection->half_width = 5;
  EXPECT_EQ(seen(anyDirection()).injection.finding.reason, "a network sees its end elsewhere");
  scene_.injection.reset();
  EXPECT_FALSE(seen(anyDirection()).injection.finding.isFound());
}

TEST_F(SecondEyeTest, ADirectionThatIsToldHolds) {
  SpecimenTrackerConfig config = anyDirection();
  config.injection.any_direction = false;
  config.injection.direction = M_PI;  // from the left
  EXPECT_EQ(seen(config).injection.finding.reason,
            "the pipette comes from another side, or is not in the region that is told");
}

/// The search of the whole frame would find the same end, whose direction is told.
TEST_F(SecondEyeTest, AnEndThatItSeesElsewhereIsNotSureByAnotherSearch) {
  SpecimenTrackerConfig config = anyDirection();
  config.injection.any_direction = false;
  config.injection.direction = eye_->proposal.injection->direction();
  eye_->proposal.injection->end += cv::Point2d(60, -71);  // up the shaft
  eye_->proposal.injection->half_width = 5;
  const PipetteDetection told = seen(config).injection;
  EXPECT_LT(cv::norm(told.end - pixel(45e-6, 40e-6)), 5);
  EXPECT_EQ(told.finding.reason, "a network sees its end elsewhere");
}

/// What it takes for a holding pipette is no needle, however much glass is there.
TEST_F(SecondEyeTest, APipetteOfTheOtherKindIsNotSure) {
  scene_.injection->axis = {0, 0, 1};
  scene_.injection->tip = {0, 0, 60e-6};
  eye_->proposal.injection.reset();
  eye_->proposal.holding = ProposedPipette{pixel(0, 60e-6), pixel(0, 155e-6), 15, 20};
  eye_->proposal.glass = {cv::Mat(96, 128, CV_32F, cv::Scalar(1)), 1 / 10.9, {0, 0}, true};
  const PipetteDetection needle = seen(anyDirection()).injection;
  EXPECT_LT(cv::norm(needle.end - pixel(0, 60e-6)), 5);
  EXPECT_EQ(needle.finding.reason, "a network sees a pipette of the other kind there");
  // Who is told that the needle comes from there knows better.
  SpecimenTrackerConfig told = anyDirection();
  told.injection.any_direction = false;
  EXPECT_EQ(seen(told).injection.finding.reason, "");
  // Where it sees glass of no kind that it can tell, the needle is one.
  eye_->proposal.holding.reset();
  EXPECT_EQ(seen(anyDirection()).injection.finding.reason, "");
}

TEST_F(SecondEyeTest, APipetteThatIsNotInTheRegionThatIsToldIsNoOne) {
  SpecimenTrackerConfig config = anyDirection();
  config.injection.region = {0, 0, 200, 1000};
  EXPECT_FALSE(seen(config).injection.finding.hasValues());
}

TEST_F(SecondEyeTest, AThickZonaIsNotOverlooked) {
  scene_.cells.front() = CellScene::round({0, 0}, kSeenRadius, 12e-6, 0);
  ProposedCell& told = eye_->proposal.cells.front();
  told.zona.reset();
  told.ooplasm = {pixel(0, 0), {26e-6 / kSeenPixel, 26e-6 / kSeenPixel}, 0};
  const CellDetection cell = seen(anyDirection()).cell;
  ASSERT_TRUE(cell.zona_outer.finding.hasValues());
  EXPECT_EQ(cell.second->reason, "a network sees no zona");
  EXPECT_FALSE(cell.size.isFound());
  told.perhaps_zona = true;  // then it does not know
  EXPECT_TRUE(seen(anyDirection()).cell.second->isFound());
}

/// From frame to frame a little; what the network said holds for the size that it saw, and then it looks again.
TEST_F(SecondEyeTest, ACellThatGrowsIsNotSureForEver) {
  SpecimenTracker tracker(anyDirection(), eye_);
  const double seen = tracker.next(frame()).cell.outer().ellipse.meanDiameter();
  double diameter = seen;
  for (int i = 1; i <= 24; ++i) {
    scene_.cells.front() = CellScene::round({0, 0}, kSeenRadius * (1 + 0.007 * i), 6e-6, 0);
    const CellDetection& cell = tracker.next(frame()).cell;
    ASSERT_TRUE(cell.finding.hasValues()) << i;
    diameter = cell.outer().ellipse.meanDiameter();
    EXPECT_TRUE(diameter < 1.12 * seen || !cell.size.isFound() || eye_->looks > 1) << i << ' ' << diameter / seen;
  }
  EXPECT_GT(diameter, 1.14 * seen);
}

/// A pipette that has gone no longer tells which of two cells is the one.
TEST_F(SecondEyeTest, ACellThatIsReleasedIsOneOfTwo) {
  ProposedCell beside = eye_->proposal.cells.front();
  beside.ooplasm.centre += cv::Point2d(-400, 0);
  beside.zona->centre += cv::Point2d(-400, 0);
  beside.held = false;
  eye_->proposal.cells.push_back(beside);
  SpecimenTracker tracker(anyDirection(), eye_);
  EXPECT_EQ(tracker.next(frame()).cell.size.reason, "");
  EXPECT_EQ(tracker.next(frame()).cell.size.reason, "");
  scene_.holding.reset();
  eye_->proposal.holding.reset();
  const SpecimenView& view = tracker.next(frame());
  EXPECT_FALSE(view.holding.finding.isFound());
  EXPECT_EQ(view.cell.size.reason, CellDetection::kTwoCells);
}

/// A network sees where a mouth is along the axis better than beside it.
TEST_F(SecondEyeTest, AMouthThatItSeesElsewhereAlongTheAxisIsNotSure) {
  eye_->proposal.holding->tolerance = 80;
  EXPECT_TRUE(seen(anyDirection()).holding.finding.isFound());
  eye_->proposal.holding->end = pixel(0, -37e-6) + cv::Point2d(0, 50);  // of a half width of 133
  EXPECT_EQ(seen(anyDirection()).holding.finding.reason, "a network sees its end elsewhere");
}

/// Lips that are not clear: which edge is the mouth, the network knows, in the frames that follow too.
TEST_F(SecondEyeTest, AMouthWithUnclearLipsIsSureWhereItSeesOne) {
  const auto faint = [&] {
    cv::Mat image = microscope_.render(scene_, 0, ++seed_);
    const cv::Rect lip(cv::Point(pixel(-40e-6, -37e-6)) - cv::Point(20, 20), cv::Size(40, 40));
    cv::GaussianBlur(image(lip), image(lip), {}, 5);
    return Frame(image);
  };
  eye_->proposal.holding->tolerance = 80;
  SpecimenTracker tracker(anyDirection(), eye_);
  for (int i = 0; i < 3; ++i) {
    const PipetteDetection& mouth = tracker.next(faint()).holding;
    ASSERT_TRUE(mouth.which_end) << i;
    EXPECT_TRUE(mouth.finding.isFound()) << i << mouth.finding.reason;
    EXPECT_LT(cv::norm(mouth.end - pixel(0, -37e-6)), 2 * mouth.deviationAlong()) << i;
  }
  EXPECT_EQ(eye_->looks, 1);
  eye_->proposal.holding->end = pixel(0, -37e-6) + cv::Point2d(0, 25);
  EXPECT_EQ(SpecimenTracker(anyDirection(), eye_).next(faint()).holding.finding.reason,
            "the lips of the mouth are not clear");
}

/// A vesicle has a halo that both eyes may take for a zona.
TEST_F(SecondEyeTest, ACellWhoseBorderItSeesAsThatOfAZonaIsNotSure) {
  cv::Mat image(600, 900, CV_8U, cv::Scalar(128)), noise(image.size(), CV_8U);
  cv::circle(image, {450, 300}, 120, cv::Scalar(90), cv::FILLED);
  cv::GaussianBlur(image, image, {}, 1.5);
  cv::randn(noise, 10, 2);
  image += noise;
  eye_->proposal = {};
  eye_->proposal.cells.push_back({{{450, 300}, {114, 114}, 0}, Ellipse{{450, 300}, {130, 130}, 0}, false, false});
  const auto seen = [&] { return SpecimenTracker(anyDirection(), eye_).next(Frame(image)).cell; };
  ASSERT_TRUE(seen().size.isFound()) << seen().size.reason;
  eye_->proposal.cells.front().zona->semi_axes = {121, 121};
  EXPECT_EQ(seen().size.reason, "a network sees a zona's border where the cell's is measured");
}

/// Which of two rings is the zona's border a network cannot tell: not in the frame that is searched, and not in the
/// next.
TEST_F(SecondEyeTest, ABorderWithARingAboutItIsNotSureInTheNextFrameEither) {
  const cv::Point centre(450, 300);
  const auto frame = [&] {
    cv::Mat image(600, 900, CV_8U, cv::Scalar(128)), noise(image.size(), CV_8U);
    cv::circle(image, centre, 90, cv::Scalar(95), cv::FILLED);
    cv::circle(image, centre, 122, cv::Scalar(100), 4);
    cv::circle(image, centre, 150, cv::Scalar(112), 3);
    cv::GaussianBlur(image, image, {}, 1.5);
    cv::randn(noise, 10, 2);
    return Frame(image + noise);
  };
  eye_->proposal = {};
  eye_->proposal.cells.push_back({{centre, {90, 90}, 0}, Ellipse{centre, {122, 122}, 0}, false, false});
  SpecimenTracker tracker(anyDirection(), eye_);
  for (int i = 0; i < 3; ++i) {
    const CellDetection& cell = tracker.next(frame()).cell;
    EXPECT_FALSE(cell.confirmed) << i;
    EXPECT_NE(cell.size.reason.find("a ring is seen outside"), std::string::npos) << i << cell.size.reason;
  }
}

TEST_F(SecondEyeTest, LooksWhereSomethingIsSearchedOnly) {
  SpecimenTracker tracker(anyDirection(), eye_);
  for (int i = 0; i < 5; ++i) tracker.next(frame());
  EXPECT_EQ(eye_->looks, 1);
}

}  // namespace
}  // namespace microinjection
