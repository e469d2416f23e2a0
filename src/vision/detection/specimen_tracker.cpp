#include "vision/detection/specimen_tracker.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kNearCell = 1.6;  // over the cell's radius: of a tip this near the gap or the dimple is measured

PipetteDetectorConfig readPipette(ConfigReader& reader, const std::string& kind, double direction) {
  PipetteDetectorConfig config = PipetteDetectorConfig::read(reader);
  if (!reader.has("direction")) config.direction = direction;
  config.kind = kind;
  return config;
}

/// What a later search cannot better: a pipette that was found, a cell whose diameter was.
bool isSure(const PipetteDetection& pipette) { return pipette.finding.isFound(); }
bool isSure(const CellDetection& cell) { return cell.size.isFound(); }

/// The thing near its last place, else anywhere. What is followed is not lost by a search that finds nothing.
/// `age`: frames since the whole one was searched for it.
template <typename Detector, typename Detection>
Detection follow(const Detector& detector, const Frame& frame, const Detection& last, double reach, int& age) {
  ++age;
  Detection tracked;
  if (last.finding.hasValues()) tracked = detector.track(frame, last, reach);
  const bool followed = last.finding.hasValues() && tracked.finding.hasValues();
  if (followed && (isSure(tracked) || age < SpecimenTracker::kSearchEvery)) return tracked;
  age = 0;
  const Detection found = detector.detect(frame);
  return followed && !found.finding.hasValues() ? tracked : found;
}

/// Whether the round thing is at the end of the pipette or behind it: lip or wall of a thick one.
bool belongsTo(const PipetteDetection& pipette, const Ellipse& thing) {
  const cv::Point2d axis(std::cos(pipette.direction), std::sin(pipette.direction));
  const cv::Point2d away = thing.centre - pipette.end;
  return away.dot(axis) > 0 && std::abs(away.cross(axis)) < pipette.half_width;
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
void takeUndisturbed(const Dimple& indentation, CellDetection& cell) {
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
  takeUndisturbed(view.indentation, view.cell);
}

SpecimenTrackerConfig SpecimenTrackerConfig::read(ConfigReader& reader) {
  SpecimenTrackerConfig config;
  reader.number("reach", config.reach, Range::closed(2, 500));
  ConfigReader cell = reader.section("cell");
  config.cell = CellDetectorConfig::read(cell);
  ConfigReader injection = reader.section("injection_pipette"), holding = reader.section("holding_pipette");
  config.injection = readPipette(injection, "injection", -M_PI / 2);
  config.holding = readPipette(holding, "holding", M_PI / 2);
  return config;
}

SpecimenTracker::SpecimenTracker(const SpecimenTrackerConfig& config)
    : config_(config), cell_(config.cell), injection_(config.injection), holding_(config.holding) {}

const SpecimenView& SpecimenTracker::next(const Frame& frame) {
  SpecimenView view;
  view.cell = follow(cell_, frame, view_.cell, config_.reach, cell_age_);
  view.injection = follow(injection_, frame, view_.injection, config_.reach, injection_age_);
  view.holding = follow(holding_, frame, view_.holding, config_.reach, holding_age_);
  if (view.holding.finding.isFound())
    view.cell.dismissOthers([&](const Ellipse& thing) { return belongsTo(view.holding, thing); });
  measureIndentation(frame, view);
  view_ = view;
  return view_;
}

}  // namespace microinjection
