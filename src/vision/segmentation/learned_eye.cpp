#include "vision/segmentation/learned_eye.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace microinjection {
namespace {

constexpr double kTolerance = 2.5;    // output px, of a place
constexpr double kLeastDiameter = 5;  // output px, of a cell
constexpr double kLeastProbability = 0.6;
constexpr double kLikely = 0.3, kLeastPipette = 0.5;  // probability, of a pixel and of a pipette
constexpr int kLeastGlass = 40;                       // output px
constexpr int kGaps = 2;                              // output px, half width of a gap in a pipette
constexpr int kRays = 72;
constexpr double kStep = 0.25, kFrom = 0.8, kTo = 2.0;  // output px; of the ooplasm's radius
constexpr double kGap = 1.5;                            // output px, of the medium within a zona
constexpr double kLeastZona = 0.5, kZonaShare = 0.7,
                 kPerhapsZona = 0.2;                       // output px; of the directions that can be seen
constexpr double kLongerThanWide = 1.2, kLeastLength = 6;  // output px, of a pipette
constexpr double kEndOfWidth = 0.5;                        // of the half width, that an end may be off
constexpr double kCloser = 0.3, kWidths = 7;               // of the frame; half widths: of the closer look's width
constexpr double kAhead = 0.15;                            // of its width, that it looks towards the shaft
constexpr double kHeld = 0.25;                             // of the diameter, from a mouth to the cell's border

float at(const cv::Mat& plane, const cv::Point2d& place) {
  const int x = static_cast<int>(std::lround(place.x)), y = static_cast<int>(std::lround(place.y));
  return x < 0 || y < 0 || x >= plane.cols || y >= plane.rows ? -1 : plane.at<float>(y, x);
}

/// Looks for a zona about a cell's region of ooplasm.
void addZona(const Segmentation& segmentation, ProposedCell& proposed) {
  const Ellipse& ooplasm = proposed.ooplasm;
  const cv::Mat& zona = segmentation.probability(PixelClass::kZona);
  const cv::Mat cell = segmentation.probability(
      {PixelClass::kZona, PixelClass::kPerivitellineSpace, PixelClass::kOoplasm, PixelClass::kPolarBody});
  const cv::Mat glass = segmentation.probability({PixelClass::kHoldingPipette, PixelClass::kInjectionPipette});
  const cv::Point2d centre = segmentation.fromFrame(ooplasm.centre);
  const double pixel = segmentation.framePixels();
  std::vector<cv::Point2d> border;
  int seen = 0;
  for (int ray = 0; ray < kRays; ++ray) {
    const double direction = 2 * M_PI * ray / kRays, radius = ooplasm.radius(direction) / pixel;
    const cv::Point2d step(std::cos(direction), std::sin(direction));
    double last = 0, thickness = 0, gap = 0;
    bool open = true;
    for (double r = kFrom * radius; r < kTo * radius && gap < kGap; r += kStep) {
      const cv::Point2d place = centre + r * step;
      if (at(cell, place) < 0 || at(glass, place) > 0.5F) {
        open = false;
        break;
      }
      const bool inside = at(cell, place) > 0.5F;
      gap = inside ? 0 : gap + kStep;
      if (at(zona, place) > 0.5F) {
        thickness += kStep;
        last = r;
      }
    }
    if (!open) continue;
    ++seen;
    if (thickness > kLeastZona) border.push_back(segmentation.toFrame(centre + last * step));
  }
  const double share = seen < kRays / 4 ? 0 : static_cast<double>(border.size()) / seen;
  proposed.perhaps_zona = share > kPerhapsZona;
  if (share < kZonaShare) return;
  const double radius = 0.6 * ooplasm.meanDiameter();
  const EllipseFit fit = fitEllipse(border, {ooplasm.centre, {radius, radius}, 0}, kTolerance * pixel);
  if (fit.valid && fit.ellipse.meanDiameter() > ooplasm.meanDiameter()) proposed.zona = fit.ellipse;
}

constexpr std::initializer_list<PixelClass> kNeedle = {PixelClass::kInjectionPipette},
                                            kHolder = {PixelClass::kHoldingPipette, PixelClass::kBoreMedium},
                                            kGlass = {PixelClass::kInjectionPipette, PixelClass::kHoldingPipette,
                                                      PixelClass::kBoreMedium};

/// Whether more of a region is a needle than a holding pipette: parts of a thick wall look like those of the other one.
bool isNeedle(const Segmentation& segmentation, const ClassRegion& region) {
  return cv::mean(segmentation.probability(kNeedle), region.mask)[0] >
         cv::mean(segmentation.probability(kHolder), region.mask)[0];
}

std::optional<ProposedPipette> pipetteIn(const Segmentation& segmentation, bool needle) {
  for (const ClassRegion& region : segmentation.regions(kGlass, 0, kLikely, kGaps)) {
    const std::optional<RegionWay> way = segmentation.wayOf(region);
    if (!way || region.probability < kLeastPipette || isNeedle(segmentation, region) != needle) continue;
    const cv::Point2d shaft = way->entry - way->end;
    const double length = std::hypot(shaft.x, shaft.y), half_width = 0.5 * region.area / std::max(length, 1e-6);
    if (length < kLeastLength * segmentation.framePixels() || length < kLongerThanWide * half_width) continue;
    return ProposedPipette{way->end, way->entry, half_width,
                           kTolerance * segmentation.framePixels() + kEndOfWidth * half_width};
  }
  return std::nullopt;
}

/// From a mouth to a cell's border, of the cell's diameter.
double gap(const cv::Point2d& mouth, const ProposedCell& cell) {
  const Ellipse& outer = cell.zona ? *cell.zona : cell.ooplasm;
  return std::abs(outer.distance(mouth)) / outer.meanDiameter();
}

}  // namespace

ProposedPipette LearnedEye::lookCloser(const Frame& frame, const std::string& kind, const ProposedPipette& pipette) {
  const double width = std::max(kCloser * frame.width(), kWidths * pipette.half_width);
  const cv::Size size(static_cast<int>(std::min(width, frame.width())),
                      static_cast<int>(std::min(0.75 * width, frame.height())));
  const double direction = pipette.direction();
  const cv::Point2d middle = pipette.end + kAhead * width * cv::Point2d(std::cos(direction), std::sin(direction));
  const cv::Point corner(std::clamp(static_cast<int>(middle.x) - size.width / 2, 0, frame.grey().cols - size.width),
                         std::clamp(static_cast<int>(middle.y) - size.height / 2, 0, frame.grey().rows - size.height));
  const Segmentation close = segmenter_.segment(frame.grey()(cv::Rect(corner, size)));
  const std::optional<ProposedPipette> seen = pipetteIn(close, kind == "injection");
  const cv::Point2d shift(corner);
  if (!seen || cv::norm(seen->end + shift - pipette.end) > 2 * pipette.tolerance) return pipette;
  ProposedPipette closer = pipette;
  closer.end = seen->end + shift;
  closer.tolerance = seen->tolerance;
  return closer;
}

Proposal LearnedEye::proposalOf(const Segmentation& segmentation) {
  Proposal proposal;
  proposal.injection = pipetteIn(segmentation, true);
  proposal.holding = pipetteIn(segmentation, false);
  proposal.glass.probability = segmentation.probability(kGlass);
  proposal.glass.scale = 1 / segmentation.framePixels();
  proposal.glass.shift = segmentation.fromFrame({0, 0});
  proposal.glass.anywhere = cv::countNonZero(proposal.glass.probability > kLikely) > kLeastGlass;
  for (const ClassRegion& region : segmentation.regions({PixelClass::kOoplasm})) {
    if (region.diameter < kLeastDiameter * segmentation.framePixels() || region.probability < kLeastProbability)
      continue;
    ProposedCell cell;
    cell.ooplasm = {region.centre, {region.semi_major, region.semi_minor}, region.angle};
    addZona(segmentation, cell);
    proposal.cells.push_back(cell);
  }
  for (const auto& [kind, what] :
       {std::pair("bubble", PixelClass::kBubble), std::pair("debris", PixelClass::kDebris)}) {
    for (const ClassRegion& region : segmentation.regions({what})) {
      if (region.diameter < kLeastDiameter * segmentation.framePixels() || region.probability < kLeastProbability)
        continue;
      proposal.things.push_back({kind, {region.centre, {region.semi_major, region.semi_minor}, region.angle}});
    }
  }
  if (proposal.holding) {
    const auto held = std::min_element(proposal.cells.begin(), proposal.cells.end(), [&](const auto& a, const auto& b) {
      return gap(proposal.holding->end, a) < gap(proposal.holding->end, b);
    });
    if (held != proposal.cells.end()) held->held = gap(proposal.holding->end, *held) < kHeld;
  }
  std::stable_partition(proposal.cells.begin(), proposal.cells.end(),
                        [](const ProposedCell& cell) { return cell.held; });
  return proposal;
}

}  // namespace microinjection
