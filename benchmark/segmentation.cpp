// The learned eye: Dice of each class on rendered images, and its errors on real micrographs.

#include <algorithm>
#include <array>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "vision/segmentation/segmenter.h"
#include "vision/segmentation_training/training_image.h"

namespace microinjection {
namespace {

int images = 300;
std::uint64_t first_seed = 20000000;
std::string weights = std::string(MICROINJECTION_SOURCE_DIR) + "/config/vision/segmentation.onnx";

// Images that were looked at while the training scenes were chosen. All others were held out.
const std::vector<std::string> kSeen = {"oocytor_zp/movo_308", "Oocyte_3.",         "vampy/test", "usama",
                                        "holypipette/pip",     "holypipette/stack3"};

std::string rows;

void take(const std::string& row) {
  std::fputs(row.c_str(), stdout);
  std::fflush(stdout);
  rows += row;
}

std::string number(double value, const char* pattern) {
  char text[40];
  std::snprintf(text, sizeof text, pattern, value);
  return std::isfinite(value) ? text : "";
}

/// Pixels of each class: in truth, as said, and both.
struct ClassCounts {
  std::array<double, kPixelClasses> truth{}, said{}, both{};

  void add(const cv::Mat& label, const cv::Mat& classes) {
    for (std::size_t i = 0; i < kPixelClasses; ++i) {
      const cv::Mat is = label == static_cast<int>(i), says = (classes == static_cast<int>(i)) & (label != kNoLabel);
      truth[i] += cv::countNonZero(is);
      said[i] += cv::countNonZero(says);
      both[i] += cv::countNonZero(is & says);
    }
  }
};

void renderedRows(Segmenter& segmenter) {
  std::map<std::string, ClassCounts> modes;
  TrainingImages source;
  for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(images); ++seed) {
    const TrainingImage image = source.make(seed);
    const Frame frame(image.picture);
    if (!frame.refusal().empty()) continue;
    const cv::Mat label = workingLabel(image.label, WorkingImage(frame.grey()));
    const cv::Mat classes = segmenter.segment(frame).classes();
    for (const std::string& mode : {std::string("all modes"), std::string(toText(image.contrast_mode))})
      modes[mode].add(label, classes);
  }
  for (const auto& [mode, counts] : modes)
    for (std::size_t i = 0; i < kPixelClasses; ++i)
      take("rendered," + mode + "," + kPixelClassNames[i] + "," +
           number(2 * counts.both[i] / (counts.truth[i] + counts.said[i]), "%.3f") + ",,,\n");
}

/// A line of GROUND_TRUTH.csv.
struct RealReading {
  std::string file, object;
  double x = 0, y = 0, dx = 0, dy = 0, angle = 0;
};

std::vector<RealReading> realReadings(const std::string& folder) {
  std::vector<RealReading> all;
  std::ifstream file(folder + "/GROUND_TRUTH.csv");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line.rfind("file,", 0) == 0) continue;
    std::istringstream text(line);
    std::vector<std::string> cells;
    for (std::string part; std::getline(text, part, ',');) cells.push_back(part);
    if (cells.size() < 7) continue;
    const auto value = [&](int i) { return std::atof(cells[static_cast<std::size_t>(i)].c_str()); };
    all.push_back({cells[0], cells[1], value(2), value(3), value(4), value(5), value(6)});
  }
  return all;
}

std::string setOf(const std::string& file) {
  const bool seen = std::any_of(kSeen.begin(), kSeen.end(),
                                [&](const std::string& part) { return file.find(part) != std::string::npos; });
  return seen ? "seen" : "held_out";
}

cv::Mat imageOf(const std::string& folder, const std::string& file) {
  const cv::Mat image = cv::imread(folder + "/" + file, cv::IMREAD_UNCHANGED);
  if (image.empty()) throw ConfigError(folder + "/" + file + ": cannot be read");
  // The lower half of this source's images is its own segmentation, drawn.
  return file.rfind("usama", 0) == 0 ? image.rowRange(0, image.rows / 2) : image;
}

std::initializer_list<PixelClass> classesOf(const std::string& object) {
  static const std::initializer_list<PixelClass> cell = {PixelClass::kZona, PixelClass::kPerivitellineSpace,
                                                         PixelClass::kOoplasm, PixelClass::kPolarBody};
  static const std::initializer_list<PixelClass> inner = {PixelClass::kPerivitellineSpace, PixelClass::kOoplasm,
                                                          PixelClass::kPolarBody};
  static const std::initializer_list<PixelClass> ooplasm = {PixelClass::kOoplasm};
  // The glass of either kind: which of them it is, is another question than where it ends.
  static const std::initializer_list<PixelClass> pipette = {PixelClass::kInjectionPipette, PixelClass::kHoldingPipette,
                                                            PixelClass::kBoreMedium};
  if (object == "pipette_tip" || object == "pipette_mouth") return pipette;
  return object == "zona_outer" ? cell : object == "zona_inner" ? inner : ooplasm;
}

/// Dice of the region with the ellipse of the reading, in output pixels.
double diceWith(const RealReading& reading, const Segmentation& segmentation, const ClassRegion& region) {
  cv::Mat ellipse(region.mask.size(), CV_8U, cv::Scalar(0));
  const double pixel = segmentation.framePixels();
  const cv::Point2d centre = segmentation.fromFrame({reading.x, reading.y});
  cv::ellipse(
      ellipse,
      cv::RotatedRect(centre, cv::Size2d(reading.dx / pixel, reading.dy / pixel), static_cast<float>(reading.angle)),
      255, cv::FILLED);
  return 2.0 * cv::countNonZero(ellipse & region.mask) / (cv::countNonZero(ellipse) + cv::countNonZero(region.mask));
}

void cellRow(const RealReading& reading, const Segmentation& segmentation, const std::string& begin, double time) {
  const double diameter = std::sqrt(reading.dx * reading.dy);
  for (const ClassRegion& region : segmentation.regions(classesOf(reading.object))) {
    const double away = cv::norm(region.centre - cv::Point2d(reading.x, reading.y));
    if (away > diameter / 4) continue;
    take(begin + number(diceWith(reading, segmentation, region), "%.3f") + "," +
         number(region.diameter / diameter - 1, "%.4f") + "," + number(away, "%.1f") + "," +
         number(1e3 * time, "%.1f") + "\n");
    return;
  }
  take(begin + "0,,," + number(1e3 * time, "%.1f") + "\n");
}

void pipetteRow(const RealReading& reading, const Segmentation& segmentation, const std::string& begin, double time) {
  double nearest = std::nan("");
  for (const ClassRegion& region : segmentation.regions(classesOf(reading.object))) {
    const auto way = segmentation.wayOf(region);
    if (!way) continue;
    nearest = cv::norm(way->end - cv::Point2d(reading.x, reading.y));
    break;  // the largest
  }
  take(begin + ",," + number(nearest, "%.1f") + "," + number(1e3 * time, "%.1f") + "\n");
}

void realRows(Segmenter& segmenter, const std::string& folder) {
  for (const RealReading& reading : realReadings(folder)) {
    const Frame frame(imageOf(folder, reading.file));
    const double began = threadCpuTime();
    const Segmentation segmentation = segmenter.segment(frame);
    const double time = threadCpuTime() - began;
    const std::string begin = setOf(reading.file) + "," + reading.file + "," + reading.object + ",";
    if (reading.object.rfind("pipette", 0) == 0) {
      pipetteRow(reading, segmentation, begin, time);
    } else {
      cellRow(reading, segmentation, begin, time);
    }
  }
  for (const int well : {1, 2, 7, 8}) {
    const std::string name = "autooocyte/finalOocyte_1_Oocyte_" + std::to_string(well) + ".jpg";
    const Frame frame(imageOf(folder, name));
    const Segmentation segmentation = segmenter.segment(frame);
    const auto cell = segmentation.largestRegion(classesOf("zona_outer"));
    take("seen," + name + ",empty_well: share of the image taken for a cell," +
         number((cell ? cell->area : 0) / (frame.width() * frame.height()), "%.4f") + ",,,\n");
  }
}

std::string table() {
  cv::setNumThreads(1);
  Segmenter segmenter(weights);
  take("set,image,what,dice,diameter_relative_error,away_px,time_ms\n");
  renderedRows(segmenter);
  if (const char* folder = std::getenv("MICROINJECTION_MICROGRAPHS")) realRows(segmenter, folder);
  return rows;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description more;
  more.add_options()("images", po::value(&microinjection::images)->default_value(300), "rendered images")(
      "seed", po::value(&microinjection::first_seed)->default_value(20000000),
      "of the first; below are the learnt ones")(
      "weights", po::value(&microinjection::weights)->default_value(microinjection::weights), "ONNX file");
  return microinjection::benchMain(argc, argv,
                                   "bench_segmentation: the segmentation network on rendered images, and on real ones "
                                   "where MICROINJECTION_MICROGRAPHS names their folder.",
                                   microinjection::table, more);
}
