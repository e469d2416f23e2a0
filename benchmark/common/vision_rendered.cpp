#include <yaml-cpp/yaml.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "base/cpu_time.h"
#include "benchmark/common/stated_interval.h"
#include "benchmark/common/tracked_time.h"
#include "benchmark/common/vision_cases.h"
#include "vision/microscope/microscope.h"
#include "vision/track/bore_measurement.h"
#include "vision/track/frame_search.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {
namespace {

// The goals, px and degrees.
constexpr double kCentre = 0.15, kZona = 0.5, kTip = 0.2, kMouth = 0.5, kAxis = 0.2, kDimple = 0.3, kPolarBody = 2,
                 kBore = 0.3;
constexpr double kDiameter = 0.003;  // of the diameter
constexpr double kInDegrees = 180 / M_PI;
const cv::Point2d kMoved(4, -3);  // px, that a pipette is thought to be off before it is tracked

template <typename Call>
auto timed(double& seconds, const Call& call) {
  const double begin = threadCpuTime();
  auto result = call();
  seconds = threadCpuTime() - begin;
  return result;
}

/// An error with what the detector states of it.
struct StatedError {
  double error = 0;      ///< absolute
  double deviation = 0;  ///< standard deviation
  bool covered = false;  ///< see VisionRow
};

StatedError stated(double error, double deviation) { return {std::abs(error), deviation, covers(error, deviation)}; }

StatedError stated(const cv::Point2d& place, const Eigen::Vector2d& truth, const Eigen::Matrix2d& covariance) {
  const cv::Point2d off(place.x - truth.x(), place.y - truth.y());
  return {std::hypot(off.x, off.y), deviationOf(covariance), covers(off, covariance)};
}

/// The rows of one rendered image.
class ImageRows {
 public:
  ImageRows(const std::string& set, std::uint64_t seed, const TakeRow& take)
      : set_(set), image_(std::to_string(seed)), take_(take) {}

  void add(const std::string& what, const Finding& finding, const StatedError& stated, double truth, double goal,
           double time = std::numeric_limits<double>::quiet_NaN()) const {
    VisionRow row = rowFor(what, finding, time);
    if (row.found) {
      row.error = stated.error;
      row.relative = truth > 0 ? stated.error / truth : std::numeric_limits<double>::quiet_NaN();
      row.deviation = stated.deviation;
      row.covered = stated.covered;
      row.wrong = row.sure && stated.error > kWrongFactor * goal;
    }
    take_(row);
  }
  /// Of something that is not in the image: found is wrong.
  void addAbsent(const std::string& what, const Finding& finding, double time) const {
    VisionRow row = rowFor(what, finding, time);
    row.wrong = row.sure;
    take_(row);
  }
  void addTime(const std::string& what, double time) const {
    VisionRow row{set_, image_, what};
    row.time = time;
    take_(row);
  }
  void take(const VisionRow& row) const { take_(row); }
  VisionRow rowFor(const std::string& what, const Finding& finding, double time) const {
    VisionRow row{set_, image_, what};
    row.found = finding.hasValues();
    row.sure = finding.isFound();
    row.verdict = nameOf(finding.verdict);
    row.reason = finding.reason;
    row.time = time;
    return row;
  }

 private:
  std::string set_, image_;
  const TakeRow& take_;
};

double meanDiameter(const Eigen::Vector2d& semi_axes) { return 2 * std::sqrt(semi_axes[0] * semi_axes[1]); }

void cellRows(const ImageRows& rows, const CellDetection& cell, const CellTruth& truth, double time) {
  rows.add("cell_centre", cell.finding, stated(cell.centre, truth.centre, cell.centre_covariance), truth.diameter,
           kCentre, time);
  StatedError diameter;
  if (cell.finding.hasValues())
    diameter = stated(cell.outer().ellipse.meanDiameter() - truth.diameter, diameterDeviation(cell.outer()));
  rows.add("cell_diameter", cell.size, diameter, truth.diameter, kDiameter * truth.diameter);
  if (!(truth.zona_inner[0] > 0)) return;
  const double inner = meanDiameter(truth.zona_inner), ooplasm = meanDiameter(truth.ooplasm);
  const auto add = [&](const std::string& what, const CellBorder& border, double expected) {
    const StatedError radius = border.finding.hasValues() ? stated(0.5 * (border.ellipse.meanDiameter() - expected),
                                                                   0.5 * diameterDeviation(border))
                                                          : StatedError{};
    rows.add(what, border.finding, radius, 0, kZona);
  };
  add("zona_outer", cell.zona_outer, truth.diameter);
  add("zona_inner", cell.zona_inner, inner);
  add("ooplasm", cell.ooplasm, ooplasm);
}

/// The angle in degrees; where the cell has no polar body, whether one is claimed.
void polarBodyRow(const ImageRows& rows, const PolarBody& body, const CellTruth& truth) {
  if (!truth.polar_body_angle) {
    rows.addAbsent("polar_body_absent", body.finding, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const double turn = std::remainder(body.angle - *truth.polar_body_angle, 2 * M_PI);
  rows.add("polar_body_angle", body.finding, stated(turn * kInDegrees, body.deviation * kInDegrees), 0, kPolarBody);
}

PipetteDetection pipetteRows(const ImageRows& rows, const std::string& what, const Frame& frame,
                             const PipetteDetector& detector, FrameSearch& search,
                             const std::optional<PipetteTruth>& truth, double goal) {
  double time = 0, following = 0;
  const PipetteDetection found = timed(time, [&] { return search.pipette(detector); });
  if (!truth) rows.addAbsent(what, found.finding, time);
  if (!truth || !frame.contains({truth->end.x(), truth->end.y()}, 8)) return found;
  rows.add(what, found.finding, stated(found.end, truth->end, found.covariance), 0, goal, time);
  const double turn = std::remainder(found.direction - std::atan2(truth->axis.y(), truth->axis.x()), 2 * M_PI);
  rows.add(what + "_axis", found.finding, stated(turn * kInDegrees, found.direction_deviation * kInDegrees), 0, kAxis);
  if (!found.finding.hasValues()) return found;
  PipetteDetection before = found;
  before.end += kMoved;
  const PipetteDetection again = timed(following, [&] { return detector.track(frame, before, 8); });
  rows.add(what + "_tracked", again.finding, stated(again.end, truth->end, again.covariance), 0, goal, following);
  return found;
}

/// A cell that was searched and then tracked, with the needle that may press it.
struct SeenCell {
  SpecimenView found, tracked;
  double time = 0, following = 0, indentation = 0;  ///< s of processor time
};

/// The cell without the needle.
SeenCell seenCell(const CellDetector& detector, const Frame& frame, FrameSearch& search) {
  SeenCell seen;
  seen.found.cell = timed(seen.time, [&] { return search.cell(detector); });
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
  rows.add("cell_tracked", again.finding, stated(again.centre, truth.cell->centre, again.centre_covariance), 0, kCentre,
           reading + seen.following);
  if (!truth.cell->dimple_depth) return;
  const double depth = *truth.cell->dimple_depth;
  const Dimple& found = seen.found.indentation;
  rows.add("dimple_depth", found.finding, stated(found.depth - depth, found.deviation), depth, kDimple,
           seen.indentation);
}

/// What is in the bores, and whether the cell is at the mouth. A tongue that is shorter than this is not looked for.
constexpr double kShortTongue = 16;  // px

void boreRows(const ImageRows& rows, const Frame& frame, const PipetteDetection& holding, SpecimenView view,
              const SceneTruth& truth) {
  view.holding = holding;
  double time = 0;
  timed(time, [&] {
    measureBores(frame, ContrastMode::kBrightField, view);
    return true;
  });
  const auto add = [&](const std::string& what, const BoreBorder& border, const std::optional<double>& length) {
    if (!length) return rows.addAbsent(what + "_absent", border.finding, time);
    rows.add(what, border.finding, stated(border.length - *length, border.deviation), *length, kBore, time);
  };
  add("column", view.column, truth.in_needle);
  if (!truth.in_holder || *truth.in_holder > kShortTongue) add("tongue", view.tongue, truth.in_holder);
  if (!truth.cell) return rows.addAbsent("hold_absent", view.hold.finding, time);
  VisionRow row = rows.rowFor(truth.held ? "held" : "lost", view.hold.finding, time);
  row.wrong = row.sure && view.hold.held != truth.held;
  rows.take(row);
}

/// Times of whole frames, as the node vision has them: of the first one, which is searched, and of the same one again,
/// in which what was found is tracked. With `_missing` where cell, tip or mouth was not found.
void frameTimeRows(const ImageRows& rows, const SpecimenTrackerConfig& config, const std::shared_ptr<SecondEye>& eye,
                   const cv::Mat& image) {
  SpecimenTracker tracker(config, eye);
  double first = 0;
  const SpecimenView seen = timed(first, [&] { return tracker.next(Frame(image)); });
  const bool complete =
      seen.cell.finding.hasValues() && seen.injection.finding.hasValues() && seen.holding.finding.hasValues();
  rows.addTime(complete ? "first_frame" : "first_frame_missing", first);
  rows.addTime(complete ? "tracked_frame" : "tracked_frame_missing", trackedTime(tracker, image));
}

}  // namespace

RenderedImage renderedImage(const VisionCondition& condition, Microscope& microscope, std::uint64_t seed) {
  const DrawnScene drawn = drawScene(condition.draw, condition.microscope.camera, seed);
  return {microscope.render(drawn.scene, condition.focus, seed), drawn.truth};
}

SpecimenTrackerConfig trackerConfig(const VisionCondition& condition) {
  ConfigReader nothing(YAML::Node(YAML::NodeType::Map), "");
  SpecimenTrackerConfig config = SpecimenTrackerConfig::read(nothing);
  config.cell.smallest_diameter = 200;
  config.cell.largest_diameter = 640;
  config.cell.contrast_mode = condition.microscope.contrast.mode;
  const auto direction = [&](double y) {
    const Eigen::Vector2d shaft = condition.microscope.camera.imageDirection({0, y});
    return std::atan2(shaft.y(), shaft.x());
  };
  config.injection.direction = direction(1);
  config.holding.direction = direction(-1);
  config.injection.any_direction = config.holding.any_direction = false;
  return config;
}

void renderedRows(const VisionCondition& condition, std::uint64_t first, int images, bool pipettes_only,
                  const std::shared_ptr<SecondEye>& eye, const TakeRow& take) {
  cv::setNumThreads(1);
  Microscope microscope(condition.microscope);
  const SpecimenTrackerConfig config = trackerConfig(condition);
  const CellDetector detector(config.cell);
  const PipetteDetector injection(config.injection), holding(config.holding);
  for (int i = 0; i < images; ++i) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
    const RenderedImage drawn = renderedImage(condition, microscope, seed);
    const ImageRows rows(condition.name, seed, take);
    double reading = 0;
    const Frame frame = timed(reading, [&] { return Frame(drawn.image); });
    FrameSearch search(frame, eye.get());
    SeenCell seen;
    if (!pipettes_only) seen = seenCell(detector, frame, search);
    const PipetteDetection needle = pipetteRows(rows, "tip", frame, injection, search, drawn.truth.injection, kTip);
    const PipetteDetection mouth = pipetteRows(rows, "mouth", frame, holding, search, drawn.truth.holding, kMouth);
    if (pipettes_only) continue;
    addNeedle(frame, needle, seen);
    seenRows(rows, seen, drawn.truth, reading);
    if (condition.draw.in_needle > 0) boreRows(rows, frame, mouth, seen.found, drawn.truth);
    frameTimeRows(rows, config, eye, drawn.image);
  }
}

}  // namespace microinjection
