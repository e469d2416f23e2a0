#include "vision/track/specimen_tracker.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "vision/track/bore_measurement.h"
#include "vision/track/frame_search.h"
#include "vision/track/view_scale.h"

namespace microinjection {
namespace {

constexpr double kHeld = 0.25;     // of the cell's diameter, a mouth from its border
constexpr double kNearCell = 1.6;  // over the cell's radius: of a tip this near the gap or the dimple is measured
const cv::Size kSamples(96, 72);
constexpr double kSameScene = 0.5;  // correlation of two frames' samples, at least
constexpr double kBlank = 3;        // deviations of a pixel's noise, of the samples of a frame that shows nothing

/// What a later search cannot better: a pipette that was found, a cell whose diameter was.
bool isSure(const PipetteDetection& pipette) { return pipette.finding.isFound(); }
bool isSure(const CellDetection& cell) { return cell.size.isFound(); }

/// The thing near its last place, else anywhere. What is followed is not lost by a search that finds nothing, nor, but
/// for the rarest ones, by one that finds nothing sure: its lines would jump to others.
template <typename Detector, typename Detection, typename Search>
Detection follow(const Detector& detector, const Frame& frame, const Detection& last, double reach, SearchPace& pace,
                 const Search& search) {
  Detection tracked;
  tracked.finding = last.finding;
  const bool was_there = last.finding.hasValues();
  if (was_there) tracked = detector.track(frame, last, reach);
  const bool followed = tracked.finding.hasValues(), sure = followed && isSure(tracked);
  if (sure || (!followed && was_there && isSure(last))) pace = SearchPace();
  if (sure || !pace.isDue(followed ? SpecimenTracker::kSearchEvery : SpecimenTracker::kSearchMissingEvery))
    return tracked;
  const Detection found = search(detector);
  const bool rare = pace.waited() >= SpecimenTracker::kSearchEvery;
  pace.searched(isSure(found));
  return followed && !(rare ? found.finding.hasValues() : isSure(found)) ? tracked : found;
}

/// Correlation of two images of one size.
double correlationOf(const cv::Mat& a, const cv::Mat& b) {
  const cv::Mat away_a = a - cv::mean(a)[0], away_b = b - cv::mean(b)[0];
  return away_a.dot(away_b) / std::max(std::sqrt(away_a.dot(away_a) * away_b.dot(away_b)), 1e-12);
}

/// Whether the round thing is at the end of the pipette or behind it: lip or wall of a thick one.
bool belongsTo(const PipetteDetection& pipette, const Ellipse& thing) {
  const cv::Point2d axis(std::cos(pipette.direction), std::sin(pipette.direction));
  const cv::Point2d away = thing.centre - pipette.end;
  return away.dot(axis) > 0 && std::abs(away.cross(axis)) < pipette.half_width;
}

/// Whether a mouth that is sure is at the cell's border: without a pipette the border itself looks like an unclear
/// mouth.
bool isHeldBy(const PipetteDetection& holding, const CellDetection& cell) {
  const Ellipse& outer = cell.outer().ellipse;
  return holding.finding.isFound() && std::abs(outer.distance(holding.end)) < kHeld * outer.meanDiameter();
}

Dimple indentationOf(const Frame& frame, const SpecimenView& view) {
  Dimple none;
  if (!view.cell.finding.hasValues() || !view.injection.finding.hasValues()) {
    none.finding = Finding::notFound(view.cell.finding.hasValues() ? "no tip was found" : "no cell was found");
    return none;
  }
  const CellBorder& outer = view.cell.outer();
  const cv::Point2d away = view.injection.end - view.cell.centre;
  if (std::hypot(away.x, away.y) > kNearCell * 0.5 * outer.ellipse.meanDiameter()) {
    none.finding = Finding::notFound("the needle is not at the cell");
    return none;
  }
  Dimple found = findIndentation(frame, outer, view.injection);
  if (found.finding.isFound() && !view.cell.finding.isFound()) found.finding = view.cell.finding;
  return found;
}

/// See measureIndentation().
void centreOnUndentedOutline(const Dimple& indentation, CellDetection& cell) {
  if (!indentation.at_cell) return;
  if (indentation.outline_found) {
    cell.centre = indentation.outline.centre;
    cell.centre_covariance = indentation.centre_covariance;
    return;
  }
  for (Finding* bent : {&cell.finding, &cell.size}) {
    if (bent->isFound())
      *bent = Finding::uncertain("a needle bends the border, and the outline without it is not clear");
  }
}

}  // namespace

void measureIndentation(const Frame& frame, SpecimenView& view) {
  view.indentation = indentationOf(frame, view);
  centreOnUndentedOutline(view.indentation, view.cell);
}

SpecimenTracker::SpecimenTracker(const SpecimenTrackerConfig& config, std::shared_ptr<SecondEye> eye)
    : config_(config),
      eye_(std::move(eye)),
      cell_(config.cell),
      injection_(config.injection),
      holding_(config.holding) {}

void SpecimenTracker::setScales(const Scales& scales) {
  if (scales == scales_) return;
  seen_ = scaled(seen_, scales.all / scales_.all);
  scales_ = scales;
  cell_ = CellDetector(scaled(config_.cell, scales.all));
  holding_ = PipetteDetector(scaled(config_.holding, scales.all));
  injection_ = PipetteDetector(scaled(config_.injection, scales.needle));
}

void SearchPace::searched(bool sure) {
  searches_ = sure ? 0 : searches_ + 1;
  wait_ = searches_ < kFirst ? 0 : std::clamp(2 * wait_, 2, SpecimenTracker::kSearchEvery);
  since_ = 0;
}

/// Compares single pixels of both frames: of what shows noise alone nothing can be said.
bool SpecimenTracker::isAnotherScene(const Frame& frame) {
  cv::Mat samples;
  cv::Scalar mean, spread;
  if (frame.refusal().empty()) cv::resize(frame.grey(), samples, kSamples, 0, 0, cv::INTER_NEAREST);
  if (!samples.empty()) cv::meanStdDev(samples, mean, spread);
  const bool blank = !samples.empty() && spread[0] < kBlank * frame.noise();
  const bool another = samples.empty() || samples_.empty() || (!blank && correlationOf(samples, samples_) < kSameScene);
  samples_ = samples;
  return another;
}

const SpecimenView& SpecimenTracker::next(const Frame& frame) {
  int level = 0;
  while (std::ldexp(frame.width(), -level) > kWidest) ++level;
  const int finer = frame.width() < kNarrow ? level - 1 : level;
  setScales({std::ldexp(1, -level), std::ldexp(1, -finer)});
  const Frame searched = frame.resized(level);
  seen_ = finer == level ? lookAt(searched, searched) : lookAt(searched, frame.resized(finer));
  view_ = scaled(seen_, 1 / scales_.all);
  return view_;
}

SpecimenView SpecimenTracker::lookAt(const Frame& frame, const Frame& enlarged) {
  if (isAnotherScene(frame)) cell_pace_ = injection_pace_ = holding_pace_ = SearchPace();
  FrameSearch search(frame, eye_.get()), closer(enlarged, eye_.get());
  FrameSearch& of_needle = &frame == &enlarged ? search : closer;
  const double reach = scales_.all * config_.reach, finer = scales_.needle / scales_.all;
  SpecimenView view;
  view.cell = follow(cell_, frame, seen_.cell, reach, cell_pace_,
                     [&](const CellDetector& detector) { return search.cell(detector); });
  view.injection = scaled(follow(injection_, enlarged, scaled(seen_.injection, finer), finer * reach, injection_pace_,
                                 [&](const PipetteDetector& detector) { return of_needle.pipette(detector); }),
                          1 / finer);
  view.holding = follow(holding_, frame, seen_.holding, reach, holding_pace_,
                        [&](const PipetteDetector& detector) { return search.pipette(detector); });
  if (view.holding.finding.isFound())
    view.cell.dismissOthers([&](const Ellipse& thing) { return belongsTo(view.holding, thing); });
  if (view.cell.held && !isHeldBy(view.holding, view.cell)) {
    view.cell.held = false;
    view.cell.markAmbiguous();
  }
  measureIndentation(frame, view);
  measureBores(frame, config_.cell.contrast_mode, view);
  return view;
}

}  // namespace microinjection
