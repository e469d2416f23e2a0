#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "vision/measurement/touch_search.h"
#include "vision/measurement/vision_config.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

constexpr double kPixelSize = 0.25e-6;  // m
constexpr double kAllowed = 0.5e-6;     // m, of the touch
constexpr double kFarthest = 3.5e-6;    // m past the touch

/// A held cell with a needle above it, the needle `aside` (m) of its middle.
struct Place {
  std::uint64_t seed = 1;
  Eigen::Vector2d centre{0, 0};  // (x, z), m
  double radius = 38e-6, zona = 6e-6, tip_radius = 3e-6, aside = 0, start = 6e-6;
  bool round_tip = true;  // else a flat one
  bool before = false;    // the needle passes before the cell
};

void PrintTo(const Place& place, std::ostream* out) { *out << "place " << place.seed; }

/// The rendered approach of a needle that follows its set-points, with a camera of shot noise. The cell gives way
/// as an elastic half space under a rigid tip (Johnson, Contact Mechanics, 1985, 3.36 and 4.22).
class RenderedApproach {
 public:
  explicit RenderedApproach(const Place& place)
      : place_(place), tracker_(VisionConfig::standard().tracker), microscope_(config()), seed_(1000 * place.seed) {
    surface_ = place.centre.y() + std::sqrt(place.radius * place.radius - place.aside * place.aside);
    position_ = {place.centre.x() + place.aside, 0, surface_ + place.start};
    look();
  }

  TouchSearch run(const TouchSearchConfig& config) {
    TouchSearch search(config, position_, -Eigen::Vector3d::UnitZ(), input());
    for (int i = 0; i < 100000 && !search.done() && search.failure().empty(); ++i) {
      const auto setpoint = search.step(input());
      now_ += 0.01;
      if (setpoint && *setpoint != position_) {
        position_ = *setpoint;
        rested_ = now_;
      } else if (!search.waitsFor().empty() && now_ - std::max(rested_, exposed_) > 1.2 * config.settle_time) {
        look();
      }
    }
    return search;
  }

  double past() const { return surface_ - position_.z(); }  ///< m, of the tip below the undeformed surface
  double error(const TouchSearch& search) const { return surface_ - search.contact().z(); }  ///< m, late is positive

 private:
  static MicroscopeConfig config() {
    MicroscopeConfig config;
    config.camera.pixel_size = kPixelSize;
    return config;
  }

  /// m, of the surface at `side` (m) from the needle's axis.
  double displacement(double side) const {
    const double depth = place_.before ? 0 : std::max(0.0, past());
    if (depth <= 0) return 0;
    if (!place_.round_tip)
      return side <= place_.tip_radius ? depth : depth * M_2_PI * std::asin(place_.tip_radius / side);
    const double curvature = 1 / place_.tip_radius + 1 / place_.radius, a = std::sqrt(depth / curvature);
    if (side <= a) return depth - side * side * curvature / 2;
    return depth * M_1_PI * ((2 - side * side / (a * a)) * std::asin(a / side) + std::sqrt(side * side / (a * a) - 1));
  }

  CellScene cell() const {
    CellScene cell = CellScene::round(place_.centre, place_.radius, place_.zona, 0);
    cell.texture_seed = place_.seed;
    for (CellOutline* outline : {&cell.zona_outer, &cell.zona_inner, &cell.ooplasm}) {
      for (Eigen::Vector2d& corner : *outline) {
        const double height = std::clamp((corner.y() - place_.centre.y()) / (0.5 * place_.radius), 0.0, 1.0);
        corner.y() -= height * displacement(std::abs(corner.x() - position_.x()));
      }
    }
    return cell;
  }

  void look() {
    MicroscopeScene scene;
    scene.cells.push_back(cell());
    HoldingPipette holder;
    holder.mouth = place_.centre - Eigen::Vector2d(0, 0.93 * place_.radius);
    holder.inner_radius = 0.36 * place_.radius;
    holder.outer_radius = place_.radius;
    scene.holding = holder;
    InjectionPipette needle;
    needle.tip = position_;
    needle.tip_radius = place_.tip_radius;
    needle.taper = 0.07;
    needle.shaft_radius = 3.3 * place_.tip_radius;
    scene.injection = needle;
    const SpecimenView& view = tracker_.next(Frame(microscope_.render(scene, 0, ++seed_)));
    exposed_ = now_;
    observation_.reset();
    image_problem_ =
        view.cell.finding.reason + view.injection.finding.reason + view.indentation.displacement.finding.reason;
    const BorderDisplacement& seen = view.indentation.displacement;
    if (!seen.finding.isFound()) return;
    const bool certain = view.cell.finding.isFound() && view.injection.finding.isFound();
    observation_ = TouchSearch::Observation{now_, seen.depth, seen.deviation, seen.gap, certain};
  }

  TouchSearch::Input input() const { return {now_, position_, rested_, observation_, image_problem_, std::nullopt}; }

  Place place_;
  SpecimenTracker tracker_;
  Microscope microscope_;
  std::uint64_t seed_;
  double surface_ = 0, now_ = 10, rested_ = 9, exposed_ = 0;
  Eigen::Vector3d position_;
  std::optional<TouchSearch::Observation> observation_;
  std::string image_problem_;
};

class RenderedTouch : public testing::TestWithParam<Place> {};

TEST_P(RenderedTouch, IsFoundWithinHalfAMicrometre) {
  RenderedApproach approach(GetParam());
  const TouchSearch search = approach.run({});
  ASSERT_TRUE(search.done()) << search.failure();
  const double error = approach.error(search);
  RecordProperty("error_nm", static_cast<int>(1e9 * error));
  EXPECT_LT(std::abs(error), kAllowed);
  EXPECT_LT(approach.past(), kFarthest);
}

std::vector<Place> places() {
  std::vector<Place> all(8);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].seed = i + 1;
  all[1].centre = {31.3e-6, 12.7e-6};
  all[2].radius = 46e-6;
  all[2].zona = 9e-6;
  all[3].aside = 4e-6;
  all[4].tip_radius = 2e-6;
  all[4].start = 4.9e-6;
  all[5].round_tip = false;
  all[5].centre = {-20.1e-6, 5.4e-6};
  all[6].round_tip = false;
  all[6].tip_radius = 2e-6;
  all[6].aside = -3e-6;
  all[7].radius = 34e-6;
  all[7].start = 8.2e-6;
  return all;
}

INSTANTIATE_TEST_SUITE_P(Places, RenderedTouch, testing::ValuesIn(places()),
                         [](const testing::TestParamInfo<Place>& info) {
                           return "seed" + std::to_string(info.param.seed);
                         });

TEST(RenderedTouchRefusal, ANeedleBeforeTheCellDoesNotTouchIt) {
  Place place;
  place.before = true;
  RenderedApproach approach(place);
  const TouchSearch search = approach.run({});
  EXPECT_FALSE(search.done());
  EXPECT_NE(search.failure().find("does not give way"), std::string::npos) << search.failure();
  EXPECT_LT(approach.past(), TouchSearchConfig().largest_depth + 1e-6);
}

}  // namespace
}  // namespace microinjection
