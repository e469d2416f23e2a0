#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "base/cpu_time.h"
#include "benchmark/common/vision_row.h"
#include "vision/calibration/tip_focus.h"
#include "vision/detection/cell_detector.h"
#include "vision/detection/pipette_detector.h"
#include "vision/detection/tip_sharpness.h"

namespace microinjection {
namespace {

constexpr double kMarkedTip = 2, kVesicle = 1.5, kMarkedMouth = 3, kFocus = 1, kScale = 5.38;
constexpr double kOutline = 0.02;  // of the diameter

/// A line of GROUND_TRUTH.csv.
struct Reading {
  std::string file, object;
  double x = 0, y = 0, dx = 0, dy = 0;
};

std::vector<Reading> readings(const std::string& folder) {
  std::vector<Reading> all;
  std::ifstream file(folder + "/GROUND_TRUTH.csv");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line.rfind("file,", 0) == 0) continue;
    std::istringstream text(line);
    std::vector<std::string> cells;
    for (std::string part; std::getline(text, part, ',');) cells.push_back(part);
    if (cells.size() < 6) continue;
    all.push_back({cells[0], cells[1], std::atof(cells[2].c_str()), std::atof(cells[3].c_str()),
                   std::atof(cells[4].c_str()), std::atof(cells[5].c_str())});
  }
  return all;
}

/// Every second file of a source, by the order of the readings. See realRows() for what that means.
class Halves {
 public:
  std::string setOf(const std::string& file) {
    const std::string source = file.substr(0, file.find('/'));
    auto& files = seen_[source];
    const auto known = files.insert({file, static_cast<int>(files.size())}).first;
    return known->second % 2 == 0 ? "real_tune" : "real_held";
  }

 private:
  std::map<std::string, std::map<std::string, int>> seen_;
};

double directionOf(const std::string& file) {
  if (file.rfind("autopatcher", 0) == 0) return 160 * M_PI / 180;
  return file == "vampy/test.png" ? M_PI : 0;
}

VisionRow judged(const std::string& set, const Reading& reading, const Finding& finding, double error, double goal,
                 double time) {
  VisionRow row{set, reading.file, reading.object};
  row.found = finding.hasValues();
  row.sure = finding.isFound();
  row.verdict = nameOf(finding.verdict);
  row.time = time;
  if (!row.found) return row;
  row.error = error;
  row.wrong = row.sure && error > kWrongFactor * goal;
  return row;
}

VisionRow pipetteRow(const std::string& set, const Reading& reading, const cv::Mat& image) {
  PipetteDetectorConfig config;
  config.kind = reading.object == "pipette_tip" ? "injection" : "holding";
  config.direction = directionOf(reading.file);
  const double begin = threadCpuTime();
  const PipetteDetection found = PipetteDetector(config).detect(Frame(image));
  return judged(set, reading, found.finding, std::hypot(found.end.x - reading.x, found.end.y - reading.y),
                config.kind == "holding" ? kMarkedMouth : kMarkedTip, threadCpuTime() - begin);
}

VisionRow cellRow(const std::string& set, const Reading& reading, cv::Mat image) {
  // The lower half of this source's images is its own segmentation, drawn.
  if (reading.file.rfind("usama", 0) == 0) image = image.rowRange(0, image.rows / 2);
  CellDetectorConfig config;
  config.largest_diameter = 500;
  const double begin = threadCpuTime();
  const CellDetection cell = CellDetector(config).detect(Frame(image));
  const double time = threadCpuTime() - begin, diameter = std::sqrt(reading.dx * reading.dy);
  const CellBorder& border = reading.object == "zona_outer"   ? cell.zona_outer
                             : reading.object == "zona_inner" ? cell.zona_inner
                                                              : cell.ooplasm;
  const Finding finding = cell.finding.hasValues() ? border.finding : cell.finding;
  const double error = std::abs(border.ellipse.meanDiameter() - diameter);
  const bool vesicle = reading.object == "vesicle_inner_edge";
  VisionRow row = judged(set, reading, finding, error, vesicle ? kVesicle : kOutline * diameter, time);
  if (row.found) row.relative = error / diameter;
  return row;
}

/// The median of each coordinate.
cv::Point2d middleOf(const std::vector<cv::Point2d>& points) {
  std::vector<double> x, y;
  for (const cv::Point2d& point : points) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  return {medianOf(x), medianOf(y)};
}

/// Tips of the stages' stacks in every plane, and the best plane, from those images alone.
void stackRows(const std::string& folder, const std::vector<Reading>& all, const TakeRow& take) {
  PipetteDetectorConfig config;
  config.direction = 0;
  const PipetteDetector detector(config);
  std::map<int, cv::Point2d> tips;
  for (const int stage : {0, 3, 6}) {
    const std::string set = stage == 3 ? "real_held" : "real_tune", stack = "holypipette/stack" + std::to_string(stage);
    std::vector<FocusSample> planes;
    std::vector<Frame> frames;
    std::vector<cv::Point2d> ends;
    for (int plane = 0; plane <= 16; ++plane) {
      const std::string name = stack + "." + std::to_string(plane) + ".jpg";
      const Frame frame(cv::imread(folder + "/" + name, cv::IMREAD_UNCHANGED));
      const PipetteDetection found = detector.detect(frame);
      frames.push_back(frame);
      if (found.finding.isFound()) ends.push_back(found.end);
      if (plane == 8) tips[stage] = found.end;
      for (const Reading& reading : all) {
        if (reading.file != stack + ".8.jpg" || std::abs(plane - 8) > 5) continue;
        const double error = std::hypot(found.end.x - reading.x, found.end.y - reading.y);
        take(judged(set, {name, "tip_in_plane_" + std::to_string(plane)}, found.finding, error, 5, std::nan("")));
      }
    }
    // The stage stands still: one window for all planes, which are 1 um apart.
    for (std::size_t plane = 0; plane < frames.size() && !ends.empty(); ++plane)
      planes.push_back(
          {1e-6 * static_cast<double>(plane), tipSharpness(frames[plane], middleOf(ends), config.direction)});
    const FocusReport best = findFocus(planes, {});
    const Finding finding = best.verdict == FocusVerdict::kFocus    ? Finding::found()
                            : best.verdict == FocusVerdict::kUnsure ? Finding::uncertain(best.text)
                                                                    : Finding::notFound(best.text);
    take(judged(set, {stack, "best_plane"}, finding, std::abs(1e6 * best.height - 8.5), kFocus, std::nan("")));
  }
  const double scale = cv::norm(tips[0] - tips[6]) / 60;
  VisionRow row = judged("real_tune", {"holypipette", "stage_scale"}, Finding::found(), std::abs(scale - kScale),
                         0.005 * kScale, std::nan(""));
  row.relative = std::abs(scale - kScale) / kScale;
  take(row);
}

void emptyRows(const std::string& folder, const TakeRow& take) {
  CellDetectorConfig config;
  config.largest_diameter = 500;
  for (const int well : {1, 2, 7, 8}) {
    const std::string name = "autooocyte/finalOocyte_1_Oocyte_" + std::to_string(well) + ".jpg";
    const CellDetection cell =
        CellDetector(config).detect(Frame(cv::imread(folder + "/" + name, cv::IMREAD_UNCHANGED)));
    VisionRow row{well % 2 == 1 ? "real_tune" : "real_held", name, "empty_well"};
    row.found = cell.finding.hasValues();
    row.sure = cell.finding.isFound();
    row.wrong = row.sure;
    row.verdict = nameOf(cell.finding.verdict);
    take(row);
  }
}

}  // namespace

void realRows(const TakeRow& take) {
  const char* folder = std::getenv("MICROINJECTION_MICROGRAPHS");
  if (folder == nullptr) return;
  const std::vector<Reading> all = readings(folder);
  Halves halves;
  for (const Reading& reading : all) {
    const cv::Mat image = cv::imread(std::string(folder) + "/" + reading.file, cv::IMREAD_UNCHANGED);
    const std::string set = halves.setOf(reading.file);
    take(reading.object.rfind("pipette", 0) == 0 ? pipetteRow(set, reading, image) : cellRow(set, reading, image));
  }
  stackRows(folder, all, take);
  emptyRows(folder, take);
}

}  // namespace microinjection
