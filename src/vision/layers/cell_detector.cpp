#include "vision/layers/cell_detector.h"

#include <cmath>

#include "vision/layers/bubble.h"
#include "vision/layers/cell_candidates.h"

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
  const double deviation = border.which_line ? kConfirmed * border.ellipse.meanDiameter() : 0;
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
  // Only with a measured zona: without one the outline would be the same.
  const double thickness =
      zona ? layers.zona_outer.ellipse.meanDiameter() / layers.ooplasm.ellipse.meanDiameter() : kThickestOverlooked;
  Finding objection = Finding::found();
  if (proposed.zona && !zona && isNearer(*proposed.zona, proposed.ooplasm, layers.ooplasm.ellipse))
    objection = Finding::uncertain("a network sees a zona's border where the cell's is measured");
  else if (hasSameOutline(proposed, layers))
    objection = Finding::found();
  else if (proposed.zona && !zona)
    objection = Finding::uncertain("a network sees a zona, and its border was not found");
  else if (proposed.zona)
    objection = Finding::uncertain("a network sees the zona's border elsewhere");
  else if (!isSame(proposed.ooplasm, layers.ooplasm.ellipse))
    objection = Finding::uncertain("a network sees the cell's border elsewhere");
  else if (!proposed.perhaps_zona && thickness >= kThickestOverlooked)
    objection = Finding::uncertain("a network sees no zona");
  return objection;
}

const Ellipse& outlineOf(const ProposedCell& proposed) { return proposed.zona ? *proposed.zona : proposed.ooplasm; }

OtherThing otherCell(const ProposedCell* proposed, const Ellipse& outline) {
  return {proposed && proposed->zona ? "cell with zona" : "cell", outline};
}

}  // namespace

/// A place where a cell may be.
struct CellDetector::Candidate {
  std::vector<CellBorder> lines;           ///< that may be the clearest of its borders
  Ellipse outline;                         ///< of what is there
  const ProposedCell* proposed = nullptr;  ///< by a second eye; null: by the votes of edges
};

/// What was fitted there.
struct CellDetector::Fit {
  CellLayers layers;
  Finding finding = Finding::notFound("a network sees a cell without a clear border");  ///< of the diameter
  Finding second = Finding::found();  ///< whether the second eye has nothing against it
  bool confirmed = false;

  static constexpr int kBest = 3;
  int rank() const { return (second.isFound() ? 2 : 0) + (finding.isFound() ? 1 : 0) - (finding.hasValues() ? 0 : 4); }
};

void CellDetection::markAmbiguous() {
  if (held || otherCells() == 0) return;
  for (Finding* certain : {&finding, &size}) {
    if (certain->isFound()) *certain = Finding::uncertain(kTwoCells);
  }
}

CellDetectorConfig CellDetectorConfig::read(ConfigReader& reader) {
  CellDetectorConfig config;
  reader.number("smallest_diameter", config.smallest_diameter, Range::closed(20, 1e4));
  reader.number("largest_diameter", config.largest_diameter, Range::closed(20, 1e4));
  readContrastMode(reader, "contrast_mode", config.contrast_mode, true);
  reader.number("least_coverage", config.least_coverage, Range::closed(0.3, 1));
  reader.number("most_outside", config.most_outside, Range::closed(0, 0.5));
  if (config.largest_diameter < config.smallest_diameter) {
    reader.error("largest_diameter", "must not be below smallest_diameter");
  }
  return config;
}

CellDetector::CellDetector(const CellDetectorConfig& config) : config_(config) {}

std::vector<CellDetector::Candidate> CellDetector::votedCandidates(const Frame& frame, std::string& why_none) const {
  const double low = 0.5 * kThinnestOoplasm * config_.smallest_diameter, high = 0.5 * config_.largest_diameter;
  std::vector<CellBorder> borders;
  why_none = "no closed border of the size that is asked for";
  for (const CellCandidate& candidate : findCellCandidates(frame, low, high, kCandidates)) {
    const CellBorder border = findMainBorder(frame, candidate.centre, candidate.radius, config_.contrast_mode);
    if (!isClear(border)) continue;
    if (isBlack(frame, border.ellipse))
      why_none = kBubble;
    else
      borders.push_back(border);
  }
  std::sort(borders.begin(), borders.end(),
            [](const auto& a, const auto& b) { return borderScore(a) > borderScore(b); });
  std::vector<Candidate> candidates;
  for (const CellBorder& border : borders) candidates.push_back({{border}, border.ellipse});
  return candidates;
}

std::vector<CellDetector::Candidate> CellDetector::proposedCandidates(const Proposal& proposal,
                                                                      std::string& why_none) const {
  std::vector<Candidate> candidates;
  why_none = "a network sees no cell";
  for (const ProposedCell& proposed : proposal.cells) candidates.push_back({{}, outlineOf(proposed), &proposed});
  return candidates;
}

std::vector<CellBorder> CellDetector::linesOf(const Frame& frame, const Candidate& candidate) const {
  std::vector<CellBorder> lines = candidate.lines;
  if (candidate.proposed) {
    const Ellipse& ooplasm = candidate.proposed->ooplasm;
    for (const Ellipse& ellipse : {ooplasm, candidate.proposed->zona.value_or(scaled(ooplasm, kThinZona))}) {
      const CellBorder border =
          findMainBorder(frame, ellipse.centre, 0.5 * ellipse.meanDiameter(), config_.contrast_mode);
      if (isClear(border)) lines.push_back(border);
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& a, const auto& b) { return borderScore(a) > borderScore(b); });
  return lines;
}

CellDetector::Fit CellDetector::fit(const Frame& frame, const Candidate& candidate) const {
  std::optional<Fit> best;
  for (const CellBorder& line : linesOf(frame, candidate)) {
    if (best && best->rank() == Fit::kBest) break;
    Fit fit;
    fit.layers = findLayers(frame, line, config_.contrast_mode, config_.largest_diameter);
    if (const ProposedCell* proposed = candidate.proposed) {
      CellBorder& zona = fit.layers.zona_outer;
      fit.second = objectionOf(*proposed, fit.layers);
      fit.confirmed = zona.finding.hasValues() && proposed->zona && !zona.ringed &&
                      hasSameOutline(*proposed, fit.layers, kConfirmedSize);
      if (fit.confirmed) confirm(zona, false);
    }
    fit.finding = candidate.proposed ? judge(fit.layers) : judgeRound(frame, fit.layers);
    if (!best || fit.rank() > best->rank()) best = fit;
  }
  return best.value_or(Fit());
}

CellDetection CellDetector::detect(const Frame& frame, const Proposal* proposal) const {
  CellDetection detection;
  std::string why_none = frame.refusal();
  std::vector<Candidate> candidates;
  if (why_none.empty())
    candidates = proposal ? proposedCandidates(*proposal, why_none) : votedCandidates(frame, why_none);
  detection.finding = detection.size = Finding::notFound(why_none);

  std::vector<OtherThing> passed;  // candidates before the cell, which were not measured
  bool held_is_lost = false;       // another one would be taken for the cell
  for (const Candidate& candidate : candidates) {
    const bool has_cell = detection.finding.hasValues();
    if (held_is_lost || (has_cell && isWithin(detection, candidate.outline))) continue;
    const bool measure = !has_cell || !candidate.proposed;
    const Fit fitted = measure ? fit(frame, candidate) : Fit();
    const bool is_cell = fitted.finding.hasValues();
    const bool whole = candidate.proposed && outsideShare(frame, candidate.outline) < kLeastOutside;
    if (!has_cell && is_cell) {
      adopt(detection, frame, candidate, fitted);
    } else if (!has_cell) {
      detection.finding = detection.size = fitted.finding;
      held_is_lost = candidate.proposed && candidate.proposed->held;
      if (whole) passed.push_back(otherCell(candidate.proposed, candidate.outline));
    } else if (whole) {
      detection.others.push_back(otherCell(candidate.proposed, candidate.outline));
    } else if (is_cell && outermost(fitted.layers).outside < kLeastOutside &&
               !isWithin(detection, outermost(fitted.layers).ellipse)) {
      detection.others.push_back(otherCell(nullptr, outermost(fitted.layers).ellipse));
    }
  }

  std::vector<OtherThing>& others = detection.others;
  if (detection.finding.hasValues()) others.insert(others.end(), passed.begin(), passed.end());
  if (proposal && frame.refusal().empty() && !held_is_lost)
    others.insert(others.end(), proposal->things.begin(), proposal->things.end());
  detection.markAmbiguous();
  return detection;
}

CellDetection CellDetector::track(const Frame& frame, const CellDetection& previous, double reach) const {
  CellDetection detection;
  std::string lost = frame.refusal();
  if (lost.empty() && !previous.finding.hasValues()) lost = "there is no earlier cell to follow";
  CellLayers layers;
  if (lost.empty()) {
    detection.held = previous.held;
    detection.second = previous.second;
    layers.ooplasm = previous.ooplasm;
    layers.zona_inner = previous.zona_inner;
    layers.zona_outer = previous.zona_outer;
    layers = followLayers(frame, layers, config_.contrast_mode, reach);
    if (!layers.ooplasm.finding.hasValues() ||
        (previous.zona_outer.finding.hasValues() && !layers.zona_outer.finding.hasValues()))
      lost = "the cell is lost: its border is not where it was";
  }
  detection.finding = detection.size = Finding::notFound(lost);
  if (lost.empty()) follow(detection, frame, previous, layers);
  return detection;
}

void CellDetector::follow(CellDetection& detection, const Frame& frame, const CellDetection& previous,
                          CellLayers& layers) const {
  const double change = std::abs(outermost(layers).ellipse.meanDiameter() / previous.agreed_diameter - 1);
  detection.agreed_diameter = previous.agreed_diameter;
  detection.confirmed = previous.confirmed && change < kConfirmedSize;
  if (detection.confirmed) confirm(layers.zona_outer, previous.zona_outer.which_line);
  if (previous.second && change > kAgreedSize)
    detection.second = Finding::uncertain("the cell has changed its size since a network saw it");
  take(detection, layers, previous.second ? judge(layers) : judgeRound(frame, layers));
  // Others are searched in the whole frame only.
  detection.others = previous.others;
  detection.markAmbiguous();
  detection.polar_body = followPolarBody(frame, layers, config_.contrast_mode, previous.polar_body);
}

void CellDetector::adopt(CellDetection& detection, const Frame& frame, const Candidate& candidate,
                         const Fit& fit) const {
  if (candidate.proposed) {
    detection.held = candidate.proposed->held;
    detection.second = fit.second;
    detection.confirmed = fit.confirmed;
    detection.agreed_diameter = outermost(fit.layers).ellipse.meanDiameter();
  }
  take(detection, fit.layers, fit.finding);
  detection.polar_body = findPolarBody(frame, fit.layers, config_.contrast_mode);
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
  Finding finding = outer.finding;
  if (outer.outside > config_.most_outside)
    finding = Finding::uncertain("a part of the border is outside of the image");
  if (outer.outside > kMostOutside) finding = Finding::notFound("half of the border is outside of the image");
  if (diameter < config_.smallest_diameter || diameter > config_.largest_diameter)
    finding = Finding::notFound("no closed border of the size that is asked for");
  return finding;
}

Finding CellDetector::judgeRound(const Frame& frame, const CellLayers& layers) const {
  Finding finding = judge(layers);
  CellLayers without_zona;  // rings of light in a bubble look like a zona
  without_zona.main = layers.main;
  if (finding.hasValues() && isBubble(frame, layers))
    finding = Finding::notFound(kBubble);
  else if (finding.hasValues() && isBubble(frame, without_zona))
    finding = Finding::uncertain("the rim is as wide and dark as that of a bubble");
  return finding;
}

}  // namespace microinjection
