#include <cmath>
#include <opencv2/core.hpp>

#include "base/cpu_time.h"
#include "benchmark/common/vision_cases.h"
#include "vision/detection/cell_detector.h"
#include "vision/detection/pipette_detector.h"
#include "vision/detection/specimen_tracker.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

// The goals, px and degrees.
constexpr double kCentre = 0.15, kZona = 0.5, kTip = 0.2, kMouth = 0.5, kAxis = 0.2, kDimple = 0.3, kPolarBody = 2;
constexpr double kDiameter = 0.003;  // of the diameter
const cv::Point2d kMoved(4, -3);     // px, that a pipette is thought to be off before it is tracked

template <typename Call>
auto timed(double& seconds, const Call& call) {
  const double begin = threadCpuTime();
  auto result = call();
  seconds = threadCpuTime() - begin;
  return result;
}

/// The rows of one rendered image.
class ImageRows {
 public:
  ImageRows(const std::string& set, std::uint64_t seed, const TakeRow& take)
      : set_(set), image_(std::to_string(seed)), take_(take) {}

  void add(const std::string& what, const Finding& finding, double error, double truth, double goal,
           double time = std::numeric_limits<double>::quiet_NaN()) const {
    VisionRow row{set_, image_, what};
    row.found = finding.hasValues();
    row.sure = finding.isFound();
    row.verdict = nameOf(finding.verdict);
    row.time = time;
    if (row.found) {
      row.error = error;
      row.relative = truth > 0 ? error / truth : std::numeric_limits<double>::quiet_NaN();
      row.wrong = row.sure && error > kWrongFactor * goal;
    }
    take_(row);
  }
  /// Of something that is not in the image: found is wrong.
  void addAbsent(const std::string& what, const Finding& finding, double time) const {
    VisionRow row{set_, image_, what};
    row.found = finding.hasValues();
    row.sure = finding.isFound();
    row.wrong = row.sure;
    row.verdict = nameOf(finding.verdict);
    row.time = time;
    take_(row);
  }

 private:
  std::string set_, image_;
  const TakeRow& take_;
};

double meanDiameter(const Eigen::Vector2d& semi_axes) { return 2 * std::sqrt(semi_axes[0] * semi_axes[1]); }

void cellRows(const ImageRows& rows, const CellDetection& cell, const CellTruth& truth, double time) {
  const double off = std::hypot(cell.centre.x - truth.centre.x(), cell.centre.y - truth.centre.y());
  rows.add("cell_centre", cell.finding, off, truth.diameter, kCentre, time);
  const double diameter = cell.finding.hasValues() ? cell.outer().ellipse.meanDiameter() : 0;
  rows.add("cell_diameter", cell.size, std::abs(diameter - truth.diameter), truth.diameter, kDiameter * truth.diameter);
  if (!(truth.zona_inner[0] > 0)) return;
  const double inner = meanDiameter(truth.zona_inner), ooplasm = meanDiameter(truth.ooplasm);
  rows.add("zona_outer", cell.zona_outer.finding,
           0.5 * std::abs(cell.zona_outer.ellipse.meanDiameter() - truth.diameter), 0, kZona);
  rows.add("zona_inner", cell.zona_inner.finding, 0.5 * std::abs(cell.zona_inner.ellipse.meanDiameter() - inner), 0,
           kZona);
  rows.add("ooplasm", cell.ooplasm.finding, 0.5 * std::abs(cell.ooplasm.ellipse.meanDiameter() - ooplasm), 0, kZona);
}

/// The angle in degrees; where the cell has no polar body, whether one is claimed.
void polarBodyRow(const ImageRows& rows, const PolarBody& body, const CellTruth& truth) {
  if (!truth.polar_body_angle) {
    rows.addAbsent("polar_body_absent", body.finding, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const double turn = std::remainder(body.angle - *truth.polar_body_angle, 2 * M_PI);
  rows.add("polar_body_angle", body.finding, std::abs(turn) * 180 / M_PI, 0, kPolarBody);
}

PipetteDetection pipetteRows(const ImageRows& rows, const std::string& what, const Frame& frame, const CameraView& view,
                             const std::optional<PipetteTruth>& truth, double goal) {
  PipetteDetectorConfig config;
  config.kind = what == "tip" ? "injection" : "holding";
  const Eigen::Vector2d shaft = view.imageDirection({0, what == "tip" ? 1 : -1});
  config.direction = std::atan2(shaft.y(), shaft.x());
  const PipetteDetector detector(config);
  double time = 0, following = 0;
  const PipetteDetection found = timed(time, [&] { return detector.detect(frame); });
  if (!truth) rows.addAbsent(what, found.finding, time);
  if (!truth || !frame.contains({truth->end.x(), truth->end.y()}, 8)) return found;
  const double off = std::hypot(found.end.x - truth->end.x(), found.end.y - truth->end.y());
  rows.add(what, found.finding, off, 0, goal, time);
  const double turn = std::remainder(found.direction - std::atan2(truth->axis.y(), truth->axis.x()), 2 * M_PI);
  rows.add(what + "_axis", found.finding, std::abs(turn) * 180 / M_PI, 0, kAxis);
  if (!found.finding.hasValues()) return found;
  PipetteDetection before = found;
  before.end += kMoved;
  const PipetteDetection again = timed(following, [&] { return detector.track(frame, before, 8); });
  rows.add(what + "_tracked", again.finding, std::hypot(again.end.x - truth->end.x(), again.end.y - truth->end.y()), 0,
           goal, following);
  return found;
}

/// A cell that was searched and then tracked, with the needle that may press it.
struct SeenCell {
  SpecimenView found, tracked;
  double time = 0, following = 0, indentation = 0;  ///< s of processor time
};

/// The cell without the needle.
SeenCell seenCell(const CellDetector& detector, const Frame& frame) {
  SeenCell seen;
  seen.found.cell = timed(seen.time, [&] { return detector.detect(frame); });
  if (seen.found.cell.finding.hasValues())
    seen.tracked.cell = timed(seen.following, [&] { return detector.track(frame, seen.found.cell, 8); });
  return seen;
}

/// What the needle makes of the cell, as the node vision publishes it.
void addNeedle(const Frame& frame, const PipetteDetection& needle, SeenCell& seen) {
  const auto add = [&](SpecimenView& view) {
    view.injection = needle;
    measureIndentation(frame, view);
    return true;
  };
  timed(seen.indentation, [&] { return add(seen.found); });
  add(seen.tracked);
}

/// @param reading  s of processor time, that the frame took
void seenRows(const ImageRows& rows, const SeenCell& seen, const SceneTruth& truth, double reading) {
  const CellDetection& cell = seen.found.cell;
  if (!truth.cell) {
    rows.addAbsent("cell", cell.finding, reading + seen.time);
    return;
  }
  cellRows(rows, cell, *truth.cell, reading + seen.time);
  polarBodyRow(rows, cell.polar_body, *truth.cell);
  if (!cell.finding.hasValues()) return;
  const CellDetection& again = seen.tracked.cell;
  const Eigen::Vector2d& centre = truth.cell->centre;
  rows.add("cell_tracked", again.finding, std::hypot(again.centre.x - centre.x(), again.centre.y - centre.y()), 0,
           kCentre, reading + seen.following);
  if (!truth.cell->dimple_depth) return;
  const double depth = *truth.cell->dimple_depth;
  const Dimple& found = seen.found.indentation;
  rows.add("dimple_depth", found.finding, std::abs(found.depth - depth), depth, kDimple, seen.indentation);
}

}  // namespace

void renderedRows(const VisionCondition& condition, std::uint64_t first, int images, bool pipettes_only,
                  const TakeRow& take) {
  cv::setNumThreads(1);
  Microscope microscope(condition.microscope);
  CellDetectorConfig config;
  config.smallest_diameter = 200;
  config.largest_diameter = 640;
  config.look = condition.microscope.look.kind;
  const CellDetector detector(config);
  const CameraView& view = condition.microscope.camera;
  for (int i = 0; i < images; ++i) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
    const DrawnScene drawn = drawScene(condition.draw, view, seed);
    const cv::Mat image = microscope.render(drawn.scene, condition.focus, seed);
    const ImageRows rows(condition.name, seed, take);
    double reading = 0;
    const Frame frame = timed(reading, [&] { return Frame(image); });
    SeenCell seen;
    if (!pipettes_only) seen = seenCell(detector, frame);
    const PipetteDetection needle = pipetteRows(rows, "tip", frame, view, drawn.truth.injection, kTip);
    pipetteRows(rows, "mouth", frame, view, drawn.truth.holding, kMouth);
    if (pipettes_only) continue;
    addNeedle(frame, needle, seen);
    seenRows(rows, seen, drawn.truth, reading);
  }
}

}  // namespace microinjection
