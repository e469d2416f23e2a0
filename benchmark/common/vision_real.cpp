#include "benchmark/common/vision_real.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/cpu_time.h"
#include "benchmark/common/stated_interval.h"
#include "benchmark/common/tracked_time.h"

namespace microinjection {
namespace {

constexpr double kDiameterLimit = 0.02, kCentreLimit = 0.01, kZonaLimit = 0.03;  // of the diameter
constexpr double kPlaceLimit = 3;  // px of the image as it was taken, and at least twice the reading's tolerance
const cv::Size kTimedFrame(1392, 1040);

/// A measured value beside its truth.
struct Comparison {
  Finding finding;
  double error = 0, limit = 0, deviation = 0, truth = 0;
  bool covered = false;
};

/// The rows of one image.
class RealImageRows {
 public:
  RealImageRows(const std::string& set, const std::string& image, const TakeRow& take)
      : set_(set), image_(image), take_(take) {}

  void add(const std::string& what, const std::string& group, const Comparison& comparison) const {
    VisionRow row = rowFor(what, group, comparison.finding);
    row.right = row.sure && comparison.error <= comparison.limit;
    row.wrong = row.sure && !*row.right;
    if (row.found) {
      row.error = comparison.error;
      if (comparison.truth > 0) row.relative = comparison.error / comparison.truth;
      row.deviation = comparison.deviation;
      row.covered = comparison.covered;
    }
    take_(row);
  }
  /// Of something that is not in the image.
  void addAbsent(const std::string& what, const Finding& finding) const {
    VisionRow row = rowFor(what + "_absent", "absent", finding);
    row.wrong = row.sure;
    take_(row);
  }
  /// Of something that is there, and was not read.
  void addUnread(const std::string& what, const Finding& finding) const {
    take_(rowFor(what + "_unread", "unread", finding));
  }
  void addTime(const std::string& what, double time) const {
    VisionRow row{set_, image_, what};
    row.time = time;
    take_(row);
  }

 private:
  VisionRow rowFor(const std::string& what, const std::string& group, const Finding& finding) const {
    VisionRow row{set_, image_, what};
    row.group = group;
    row.found = finding.hasValues();
    row.sure = finding.isFound();
    row.verdict = nameOf(finding.verdict);
    row.reason = finding.reason;
    return row;
  }

  std::string set_, image_;
  const TakeRow& take_;
};

const ImageMark* markOf(const MarkedImage& image, const std::string& thing) {
  for (const ImageMark& mark : image.marks)
    if (mark.thing == thing && mark.in_frame) return &mark;
  return nullptr;
}

Comparison comparedPlace(const Finding& finding, const cv::Point2d& place, const Eigen::Matrix2d& covariance,
                         const ImageMark& mark, double limit) {
  const cv::Point2d off = place - mark.place;
  return {finding,       std::hypot(off.x, off.y),
          limit,         deviationOf(covariance),
          mark.diameter, covers(off, covariance, mark.tolerance)};
}

Comparison comparedDiameter(const Finding& finding, const CellBorder& border, const ImageMark& mark, double share) {
  if (!finding.hasValues()) return {finding};
  const double error = border.ellipse.meanDiameter() - mark.diameter, deviation = diameterDeviation(border);
  return {finding,   std::abs(error), share * mark.diameter + mark.tolerance,
          deviation, mark.diameter,   covers(error, deviation, mark.tolerance)};
}

void borderRow(const RealImageRows& rows, const MarkedImage& image, const std::string& thing, const CellDetection& cell,
               const CellBorder& border, double share) {
  const ImageMark* mark = markOf(image, thing);
  if (mark == nullptr) return;
  const Finding finding = cell.finding.hasValues() ? border.finding : cell.finding;
  rows.add(thing, "readable", comparedDiameter(finding, border, *mark, share));
}

void realCellRows(const RealImageRows& rows, const MarkedImage& image, const CellDetection& cell) {
  if (!image.has_cell) {
    rows.addAbsent("cell", cell.finding);
    return;
  }
  const ImageMark* vesicle = markOf(image, "vesicle");
  const ImageMark* outer = vesicle != nullptr ? vesicle : markOf(image, "zona_outer");
  if (outer == nullptr) {
    rows.addUnread("cell", cell.finding);
    return;
  }
  rows.add("cell_centre", "readable",
           comparedPlace(cell.finding, cell.centre, cell.centre_covariance, *outer,
                         kCentreLimit * outer->diameter + outer->tolerance));
  rows.add("cell_diameter", "readable", comparedDiameter(cell.size, cell.outer(), *outer, kDiameterLimit));
  if (vesicle != nullptr) rows.addAbsent("zona", cell.finding.hasValues() ? cell.zona_outer.finding : cell.finding);
  borderRow(rows, image, "zona_outer", cell, cell.zona_outer, kZonaLimit);
  borderRow(rows, image, "zona_inner", cell, cell.zona_inner, kZonaLimit);
  borderRow(rows, image, "ooplasm", cell, cell.ooplasm, kDiameterLimit);
}

void realPipetteRow(const RealImageRows& rows, const MarkedImage& image, const std::string& what, bool present,
                    const PipetteDetection& found) {
  if (!present) {
    rows.addAbsent(what, found.finding);
    return;
  }
  const ImageMark* mark = markOf(image, what);
  if (mark == nullptr) return;
  const double limit = std::max(2 * mark->tolerance, kPlaceLimit * image.scale);
  rows.add(mark->readable ? what : what + "_far", mark->readable ? "readable" : "far",
           comparedPlace(found.finding, found.end, found.covariance, *mark, limit));
}

bool isComplete(const SpecimenView& view) {
  return view.cell.finding.hasValues() && view.injection.finding.hasValues() && view.holding.finding.hasValues();
}

/// Of a frame that is searched, and of the same frame that is then tracked, see trackedTime().
void timeRows(const RealImageRows& rows, const MarkedImage& image, SpecimenTracker& tracker, double first) {
  if (image.image.size() != kTimedFrame) return;
  rows.addTime(isComplete(tracker.view()) ? "first_frame" : "first_frame_missing", first);
  const bool complete = isComplete(tracker.view());
  rows.addTime(complete ? "tracked_frame" : "tracked_frame_missing", trackedTime(tracker, image.image));
}

void imageRows(const std::string& set, const MarkedImage& image, RealSetup setup, const std::shared_ptr<SecondEye>& eye,
               bool timed, const TakeRow& take) {
  const RealImageRows rows(set, image.name, take);
  SpecimenTracker tracker(trackerConfig(image, setup), eye);
  const double begin = threadCpuTime();
  const SpecimenView view = tracker.next(Frame(image.image));
  const double time = threadCpuTime() - begin;
  realCellRows(rows, image, view.cell);
  realPipetteRow(rows, image, "tip", image.has_needle, view.injection);
  realPipetteRow(rows, image, "mouth", image.has_holding, view.holding);
  if (timed) timeRows(rows, image, tracker, time);
}

}  // namespace

SpecimenTrackerConfig trackerConfig(const MarkedImage& image, RealSetup setup) {
  ConfigReader nothing(YAML::Node(YAML::NodeType::Map), "");
  SpecimenTrackerConfig config = SpecimenTrackerConfig::read(nothing);
  if (setup == RealSetup::kDefault) return config;
  config.cell.contrast_mode = image.contrast_mode;
  config.injection.any_direction = config.holding.any_direction = false;
  config.injection.direction = image.needle;
  config.holding.direction = image.holding;
  return config;
}

void realRows(const Micrographs& micrographs, const std::vector<ImageTransform>& transforms, RealSetup setup,
              const std::shared_ptr<SecondEye>& eye, const TakeRow& take) {
  cv::setNumThreads(1);
  for (const std::string& name : micrographs.names()) {
    const MarkedImage original = micrographs.load(name);
    for (const ImageTransform& each : transforms) {
      const std::string set = (setup == RealSetup::kTold ? "told/" : "real/") + each.name;
      imageRows(set, each.apply(original), setup, eye, each.name == "identity", take);
    }
  }
}

}  // namespace microinjection
