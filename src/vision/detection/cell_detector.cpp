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

constexpr double kAgreedSize = 0.11, kAgreedPlace = 0.06;      // of the diameter
constexpr double kThinZona = 1.2, kThickestOverlooked = 1.25;  // of the ooplasm's diameter, a zona that is overlooked
constexpr double kConfirmedSize = 0.05;                        // of the diameter, that tells one line from the next
// px, standard deviation of an ooplasm's mean diameter beside that of its points: its rim is not as the models'. Chosen
// so that 95 % of rendered ones in focus are in their intervals.
constexpr double kOoplasmModel = 0.4;
constexpr double kConfirmed = 0.006;  // of the diameter, standard deviation

/// Which of several lines a border is, the second eye knows. Where that line is, is as sure as a fringe of it is wide.
/// @param doubted_before  in the frame of the search: the same line is no surer in the next one
void confirm(CellBorder& border, bool doubted_before) {
  if (border.which_line && border.finding.verdict == Verdict::kUncertain) border.finding = Finding::found();
  border.which_line = border.which_line || doubted_before;
  if (!border.which_line) return;
  const double deviation = kConfirmed * border.ellipse.meanDiameter();
  border.covariance += Eigen::Vector3d(0.25, 0.25, 1).asDiagonal() * (deviation * deviation);
}

bool isSame(const Ellipse& seen, const Ellipse& measured, double size = kAgreedSize) {
  const double diameter = measured.meanDiameter();
  return std::abs(seen.meanDiameter() - diameter) < size * diameter &&
         cv::norm(seen.centre - measured.centre) < kAgreedPlace * diameter;
}

/// Whether the size of the first one is nearer to what was measured than that of the second one.
bool isNearer(const Ellipse& first, const Ellipse& second, const Ellipse& measured) {
  const double diameter = measured.meanDiameter();
  return std::abs(first.meanDiameter() - diameter) < std::abs(second.meanDiameter() - diameter);
}

const CellBorder& outermost(const CellLayers& layers) {
  return layers.zona_outer.finding.hasValues() ? layers.zona_outer : layers.ooplasm;
}

/// Whether the outermost border is where a second eye sees it.
bool hasSameOutline(const ProposedCell& proposed, const CellLayers& layers, double size = kAgreedSize) {
  return isSame(proposed.zona ? *proposed.zona : proposed.ooplasm, outermost(layers).ellipse, size);
}

/// What a second eye has against what was measured: of the outermost border, not of what that is. It overlooks thin
/// zonae.
Finding objectionOf(const ProposedCell& proposed, const CellLayers& layers) {
  const bool zona = layers.zona_outer.finding.hasValues();
  if (proposed.zona && !zona && isNearer(*proposed.zona, proposed.ooplasm, layers.ooplasm.ellipse))
    return Finding::uncertain("a network sees a zona's border where the cell's is measured");
  if (hasSameOutline(proposed, layers)) return Finding::found();
  if (proposed.zona && !zona) return Finding::uncertain("a network sees a zona, and its border was not found");
  if (proposed.zona) return Finding::uncertain("a network sees the zona's border elsewhere");
  if (!isSame(proposed.ooplasm, layers.ooplasm.ellipse))
    return Finding::uncertain("a network sees the cell's border elsewhere");
  // Without a measured zona the outline would be the same.
  const double thickness = layers.zona_outer.ellipse.meanDiameter() / layers.ooplasm.ellipse.meanDiameter();
  const bool overlooked = proposed.perhaps_zona || thickness < kThickestOverlooked;
  return overlooked ? Finding::found() : Finding::uncertain("a network sees no zona");
}

}  // namespace

void CellDetection::doubtOneOfTwo() {
  if (held || otherCells() == 0) return;
  for (Finding* certain : {&finding, &size}) {
    if (certain->isFound()) *certain = Finding::uncertain(kTwoCells);
  }
}

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
    const Finding finding = judgeRound(frame, layers);
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
  detection.doubtOneOfTwo();
  return detection;
}

std::optional<CellDetector::Seen> CellDetector::seenAt(const Frame& frame, const ProposedCell& proposed) const {
  std::vector<CellBorder> borders;
  for (const Ellipse& ellipse : {proposed.ooplasm, proposed.zona.value_or(scaled(proposed.ooplasm, kThinZona))}) {
    const CellBorder border = findMainBorder(frame, ellipse.centre, 0.5 * ellipse.meanDiameter(), config_.look);
    if (isClear(border)) borders.push_back(border);
  }
  std::stable_sort(borders.begin(), borders.end(),
                   [](const auto& a, const auto& b) { return worthOf(a) > worthOf(b); });
  std::optional<Seen> best;
  for (const CellBorder& border : borders) {
    Seen seen;
    seen.layers = findLayers(frame, border, config_.look, config_.largest_diameter);
    seen.second = objectionOf(proposed, seen.layers);
    const bool zona = seen.layers.zona_outer.finding.hasValues();
    seen.confirmed = zona && proposed.zona && !seen.layers.zona_outer.ringed &&
                     hasSameOutline(proposed, seen.layers, kConfirmedSize);
    if (seen.confirmed) confirm(seen.layers.zona_outer, false);
    seen.finding = judge(seen.layers);
    if (!best || seen.rank() > best->rank()) best = seen;
    if (seen.rank() == Seen::kBest) break;
  }
  return best;
}

CellDetection CellDetector::detect(const Frame& frame, const Proposal& proposal) const {
  CellDetection detection;
  detection.finding = detection.size = Finding::notFound(frame.refusal());
  if (!frame.refusal().empty()) return detection;
  detection.finding = detection.size = Finding::notFound("a network sees no cell");
  std::vector<OtherThing> skipped;
  for (const ProposedCell& proposed : proposal.cells) {
    const Ellipse& outer = proposed.zona ? *proposed.zona : proposed.ooplasm;
    if (detection.finding.hasValues()) {
      if (!isWithin(detection, outer) && outsideShare(frame, outer) < kLeastOutside)
        detection.others.push_back({proposed.zona ? "cell with zona" : "cell", outer});
      continue;
    }
    const std::optional<Seen> seen = seenAt(frame, proposed);
    if (!seen || !seen->finding.hasValues()) {
      detection.finding = detection.size =
          seen ? seen->finding : Finding::notFound("a network sees a cell without a clear border");
      if (proposed.held) return detection;  // another one would be taken for the cell
      if (outsideShare(frame, outer) < kLeastOutside)
        skipped.push_back({proposed.zona ? "cell with zona" : "cell", outer});
      continue;
    }
    detection.held = proposed.held;
    detection.second = seen->second;
    detection.confirmed = seen->confirmed;
    detection.agreed_diameter = outermost(seen->layers).ellipse.meanDiameter();
    take(detection, seen->layers, seen->finding);
    detection.polar_body = findPolarBody(frame, seen->layers, config_.look);
  }
  if (detection.finding.hasValues()) detection.others.insert(detection.others.end(), skipped.begin(), skipped.end());
  detection.others.insert(detection.others.end(), proposal.things.begin(), proposal.things.end());
  detection.doubtOneOfTwo();
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
  detection.held = previous.held;
  detection.second = previous.second;
  CellLayers layers = followLayers(frame, before, config_.look, reach);
  const bool lost = !layers.ooplasm.finding.hasValues() ||
                    (previous.zona_outer.finding.hasValues() && !layers.zona_outer.finding.hasValues());
  if (lost) {
    detection.finding = detection.size = Finding::notFound("the cell is lost: its border is not where it was");
    return detection;
  }
  const double change = std::abs(outermost(layers).ellipse.meanDiameter() / previous.agreed_diameter - 1);
  detection.agreed_diameter = previous.agreed_diameter;
  detection.confirmed = previous.confirmed && change < kConfirmedSize;
  if (detection.confirmed) confirm(layers.zona_outer, previous.zona_outer.which_line);
  if (previous.second && change > kAgreedSize)
    detection.second = Finding::uncertain("the cell has changed its size since a network saw it");
  take(detection, layers, previous.second ? judge(layers) : judgeRound(frame, layers));
  // Others are searched in the whole frame only.
  detection.others = previous.others;
  detection.doubtOneOfTwo();
  detection.polar_body = followPolarBody(frame, layers, config_.look, previous.polar_body);
  return detection;
}

void CellDetector::take(CellDetection& detection, const CellLayers& layers, const Finding& size) {
  detection.ooplasm = layers.ooplasm;
  detection.zona_inner = layers.zona_inner;
  detection.zona_outer = layers.zona_outer;
  if (layers.zona_outer.finding.hasValues()) detection.ooplasm.covariance(2, 2) += kOoplasmModel * kOoplasmModel;
  const CellBorder& outer = detection.outer();
  detection.centre = outer.ellipse.centre;
  detection.centre_covariance = outer.covariance.topLeftCorner<2, 2>();
  detection.finding = detection.size = size;
  const bool centred = outer.centred && std::sqrt(detection.centre_covariance.trace()) < kSureCentre;
  if (size.hasValues() && centred && size.reason == outer.finding.reason) detection.finding = Finding::found();
  for (Finding* certain : {&detection.finding, &detection.size}) {
    if (certain->isFound() && detection.second) *certain = *detection.second;
  }
}

bool CellDetector::isClear(const CellBorder& border) const {
  return border.finding.hasValues() && border.strength >= kClearStrength && border.consistency >= kClearConsistency &&
         border.coverage >= config_.least_coverage && border.significance > kClearSignificance &&
         border.ellipse.semi_axes[0] < kMostElongated * border.ellipse.semi_axes[1];
}

Finding CellDetector::judge(const CellLayers& layers) const {
  const CellBorder& outer = outermost(layers);
  const double diameter = outer.ellipse.meanDiameter();
  if (diameter < config_.smallest_diameter || diameter > config_.largest_diameter) {
    return Finding::notFound("no closed border of the size that is asked for");
  }
  if (outer.outside > kMostOutside) return Finding::notFound("half of the border is outside of the image");
  if (outer.outside > config_.most_outside) return Finding::uncertain("a part of the border is outside of the image");
  return outer.finding;
}

Finding CellDetector::judgeRound(const Frame& frame, const CellLayers& layers) const {
  const Finding finding = judge(layers);
  if (!finding.hasValues()) return finding;
  if (isBubble(frame, layers)) return Finding::notFound(kBubble);
  CellLayers without_zona;  // rings of light in a bubble look like a zona
  without_zona.main = layers.main;
  if (isBubble(frame, without_zona)) return Finding::uncertain("the rim is as wide and dark as that of a bubble");
  return finding;
}

void CellDetector::addOther(CellDetection& detection, const CellLayers& layers) {
  const CellBorder& outer = outermost(layers);
  if (isWithin(detection, outer.ellipse)) return;
  if (outer.outside < kLeastOutside) detection.others.push_back({"cell", outer.ellipse});
}

}  // namespace microinjection
