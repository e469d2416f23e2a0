#include "vision/detection/cell_detector.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/cell_candidates.h"
#include "vision/detection/cell_layers.h"

namespace microinjection {
namespace {

constexpr int kCandidates = 6;
constexpr double kThinnestOoplasm = 0.55;  // of the outer border's diameter
constexpr double kMostOutside = 0.4, kLeastOutside = 0.02;
constexpr double kMostElongated = 1.5;  // ratio of a cell's axes
const char* const kBubble = "a round thing is a bubble: its rim is wide and black";
constexpr double kClearStrength = 0.6, kClearConsistency = 0.6, kClearSignificance = 3;

/// What overlaps the cell that was found is a part of it.
bool isWithin(const CellDetection& found, const Ellipse& other) {
  const Ellipse& first = found.outer().ellipse;
  return cv::norm(other.centre - first.centre) < 0.4 * (other.meanDiameter() + first.meanDiameter());
}

}  // namespace

CellDetectorConfig CellDetectorConfig::read(ConfigReader& reader) {
  CellDetectorConfig config;
  reader.number("smallest_diameter", config.smallest_diameter, Range::closed(20, 1e4));
  reader.number("largest_diameter", config.largest_diameter, Range::closed(20, 1e4));
  reader.choice("look", config.look, {"bright_field", "phase", "dic", "unknown"});
  reader.number("least_coverage", config.least_coverage, Range::closed(0.3, 1));
  reader.number("most_outside", config.most_outside, Range::closed(0, 0.5));
  if (config.largest_diameter < config.smallest_diameter) {
    reader.error("largest_diameter", "must not be below smallest_diameter");
  }
  return config;
}

CellDetector::CellDetector(const CellDetectorConfig& config) : config_(config) {}

CellDetection CellDetector::detect(const Frame& frame) const {
  CellDetection detection;
  if (!frame.refusal().empty()) {
    detection.finding = detection.size = Finding::notFound(frame.refusal());
    return detection;
  }
  const double low = 0.5 * kThinnestOoplasm * config_.smallest_diameter, high = 0.5 * config_.largest_diameter;
  std::vector<CellBorder> borders;
  bool black = false;
  for (const CellCandidate& candidate : findCellCandidates(frame, low, high, kCandidates)) {
    const CellBorder border = findMainBorder(frame, candidate.centre, candidate.radius, config_.look);
    if (!isClear(border)) continue;
    if (isBlack(frame, border.ellipse))
      black = true;
    else
      borders.push_back(border);
  }
  std::sort(borders.begin(), borders.end(), [](const auto& a, const auto& b) { return worthOf(a) > worthOf(b); });
  detection.finding = detection.size =
      Finding::notFound(black ? kBubble : "no closed border of the size that is asked for");
  for (const CellBorder& border : borders) {
    if (detection.finding.hasValues() && isWithin(detection, border.ellipse)) continue;
    const CellLayers layers = findLayers(frame, border, config_.look, config_.largest_diameter);
    const Finding finding = judge(frame, layers);
    if (!finding.hasValues()) {
      if (!detection.finding.hasValues()) detection.finding = detection.size = finding;
      continue;
    }
    if (detection.finding.hasValues()) {
      addOther(detection, layers);
      continue;
    }
    take(detection, layers, finding);
    detection.polar_body = findPolarBody(frame, layers, config_.look);
  }
  doubtOneOfTwo(detection);
  return detection;
}

CellDetection CellDetector::track(const Frame& frame, const CellDetection& previous, double reach) const {
  CellDetection detection;
  detection.finding = detection.size = Finding::notFound("there is no earlier cell to follow");
  if (!frame.refusal().empty()) detection.finding = detection.size = Finding::notFound(frame.refusal());
  if (!frame.refusal().empty() || !previous.finding.hasValues()) return detection;
  CellLayers before;
  before.ooplasm = previous.ooplasm;
  before.zona_inner = previous.zona_inner;
  before.zona_outer = previous.zona_outer;
  const CellLayers layers = followLayers(frame, before, config_.look, reach);
  const bool lost = !layers.ooplasm.finding.hasValues() ||
                    (previous.zona_outer.finding.hasValues() && !layers.zona_outer.finding.hasValues());
  if (lost) {
    detection.finding = detection.size = Finding::notFound("the cell is lost: its border is not where it was");
    return detection;
  }
  take(detection, layers, judge(frame, layers));
  // Others are searched in the whole frame only.
  detection.others = previous.others;
  doubtOneOfTwo(detection);
  detection.polar_body = followPolarBody(frame, layers, config_.look, previous.polar_body);
  return detection;
}

void CellDetector::take(CellDetection& detection, const CellLayers& layers, const Finding& size) {
  detection.ooplasm = layers.ooplasm;
  detection.zona_inner = layers.zona_inner;
  detection.zona_outer = layers.zona_outer;
  const CellBorder& outer = detection.outer();
  detection.centre = outer.ellipse.centre;
  detection.centre_covariance = outer.covariance.topLeftCorner<2, 2>();
  detection.finding = detection.size = size;
  const bool centred = outer.centred && std::sqrt(detection.centre_covariance.trace()) < kSureCentre;
  if (size.hasValues() && centred && size.reason == outer.finding.reason) detection.finding = Finding::found();
}

void CellDetector::doubtOneOfTwo(CellDetection& detection) {
  if (detection.others.empty()) return;
  for (Finding* certain : {&detection.finding, &detection.size}) {
    if (certain->isFound()) *certain = Finding::uncertain(CellDetection::kTwoCells);
  }
}

bool CellDetector::isClear(const CellBorder& border) const {
  return border.finding.hasValues() && border.strength >= kClearStrength && border.consistency >= kClearConsistency &&
         border.coverage >= config_.least_coverage && border.significance > kClearSignificance &&
         border.ellipse.semi_axes[0] < kMostElongated * border.ellipse.semi_axes[1];
}

Finding CellDetector::judge(const Frame& frame, const CellLayers& layers) const {
  const CellBorder& outer = layers.zona_outer.finding.hasValues() ? layers.zona_outer : layers.ooplasm;
  const double diameter = outer.ellipse.meanDiameter();
  if (diameter < config_.smallest_diameter || diameter > config_.largest_diameter) {
    return Finding::notFound("no closed border of the size that is asked for");
  }
  if (isBubble(frame, layers)) return Finding::notFound(kBubble);
  CellLayers without_zona;  // rings of light in a bubble look like a zona
  without_zona.main = layers.main;
  if (isBubble(frame, without_zona)) return Finding::uncertain("the rim is as wide and dark as that of a bubble");
  if (outer.outside > kMostOutside) return Finding::notFound("half of the border is outside of the image");
  if (outer.outside > config_.most_outside) return Finding::uncertain("a part of the border is outside of the image");
  return outer.finding;
}

void CellDetector::addOther(CellDetection& detection, const CellLayers& layers) {
  const CellBorder& outer = layers.zona_outer.finding.hasValues() ? layers.zona_outer : layers.ooplasm;
  if (isWithin(detection, outer.ellipse)) return;
  if (outer.outside < kLeastOutside) detection.others.push_back(outer.ellipse);
}

}  // namespace microinjection
