// Measures a cell in images and writes its scene; see --help.

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/exit_status.h"
#include "base/standard_output.h"
#include "cell/family/family_cell.h"
#include "cell/model/scene.h"
#include "commands/measure_cell_arguments.h"
#include "vision/camera/folder_source.h"
#include "vision/camera/image_file.h"
#include "vision/camera/video_source.h"
#include "vision/measurement/cell_measurement.h"
#include "vision/measurement/measured_scene.h"
#include "vision/measurement/sharpest_plane.h"
#include "vision/track/overlay.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

constexpr int kFound = 0, kNotFound = 3;
constexpr double kDegrees = 180 / M_PI, kNormal95 = 1.96;  // standard deviations, of the half width of an interval
constexpr double kAnyRate = 30;                            // 1/s: the time of a frame does not matter here

void addSource(FrameSource& source, SharpestPlane& search) {
  while (const std::optional<CameraFrame> frame = source.next()) search.add(*frame);
  for (const std::string& report : source.takeReports()) std::cerr << "measure_cell: " << report << '\n';
}

/// All pages of a stack: like the images of a folder, those that cannot be read are left out.
void addPages(const std::string& input, SharpestPlane& search) {
  const ImageFile file(input);
  for (std::size_t page = 0; page < file.pages(); ++page) {
    const LoadedImage loaded = file.load(page);
    if (loaded.refusal.empty()) search.add({loaded.image, std::nullopt, file.nameOf(page)});
    if (loaded.refusal.empty()) continue;
    if (file.pages() == 1) throw ConfigError(input + ": " + loaded.refusal);
    std::cerr << "measure_cell: " << file.nameOf(page) << ": " << loaded.refusal << '\n';
  }
}

void addImages(const std::string& input, SharpestPlane& search) {
  if (!fs::exists(input)) throw ConfigError(input + ": no such image, folder or video");
  if (fs::is_directory(input)) {
    FolderSource folder(input, kAnyRate, false);
    addSource(folder, search);
  } else if (hasImageName(input)) {
    addPages(input, search);
  } else {
    VideoSource video(input, kAnyRate, false);
    addSource(video, search);
  }
  if (!search.best()) throw ConfigError(input + ": has no image that can be read");
}

void writeOverlay(const std::string& path, const CellPlane& plane) {
  std::vector<unsigned char> bytes;
  cv::imencode(fs::path(path).extension().string(), drawOverlay(Frame(plane.image), plane.view.overlay()), bytes);
  writeFileAtomically(path, std::string(bytes.begin(), bytes.end()));
}

std::string verdictOf(const Finding& finding) {
  return std::string(nameOf(finding.verdict)) + (finding.reason.empty() ? "" : ": " + finding.reason);
}

void printPlane(const CellPlane& plane, const SharpestPlane& search) {
  std::cout << "image: " << plane.name << ", " << plane.number << " of " << search.planes() << ", cell measured in "
            << search.found() << '\n';
  if (search.isAtAnEnd())
    std::cerr << "measure_cell: the sharpest image is the " << (plane.number == 1 ? "first" : "last")
              << " one: the focus may lie beyond it\n";
  std::cout << "verdict: " << verdictOf(plane.view.cell.size) << '\n';
}

void printLengths(const CellMeasurement& cell, const CellPlane& plane) {
  std::cout << "diameter: " << inMicrometres(cell.diameter) << '\n';
  std::cout << "zona: " << (cell.zona_thickness ? inMicrometres(*cell.zona_thickness) : "none was found") << '\n';
  std::cout << "offset: "
            << (cell.offset ? inMicrometres(*cell.offset)
                            : "not known: holding pipette " + verdictOf(plane.view.holding.finding))
            << '\n';
  const PolarBody& body = plane.view.cell.polar_body;
  std::cout << "polar body: ";
  if (body.finding.isFound())
    std::cout << "at " << body.angle * kDegrees << " +- " << kNormal95 * body.deviation * kDegrees << " degrees\n";
  else
    std::cout << "not known: " << verdictOf(body.finding) << '\n';
}

/// What else is in the image, a line each.
void printOthers(const CellDetection& cell, double pixel_size) {
  for (const OtherThing& thing : cell.others)
    std::cout << "beside it: " << thing.kind << " at " << std::lround(thing.ellipse.centre.x) << ", "
              << std::lround(thing.ellipse.centre.y) << " px, about "
              << std::lround(1e6 * pixel_size * thing.ellipse.meanDiameter()) << " um\n";
}

/// What an uncertain cell has: numbers without intervals, since nobody knows by how much they are off.
void printUncertain(const CellDetection& cell, double pixel_size) {
  if (!cell.size.hasValues()) return;
  const auto print = [&](const char* name, double length) {
    std::cout << name << ": about " << 1e6 * pixel_size * length << " um\n";
  };
  print("diameter", cell.outer().ellipse.meanDiameter());
  const bool zona = cell.zona_outer.finding.hasValues() && cell.zona_inner.finding.hasValues();
  const Ellipse &outer = cell.zona_outer.ellipse, &inner = cell.zona_inner.ellipse;
  if (zona) print("zona", 0.5 * (outer.meanDiameter() - inner.meanDiameter()));
  std::cout << "centre: " << cell.centre.x << ", " << cell.centre.y << " px\n";
}

/// The scene of --scene with the measured lengths.
YAML::Node sceneOf(const MeasureCellArguments& arguments, const CellMeasurement& cell) {
  const YAML::Node base = loadYamlMap(arguments.scene);
  if (cell.zona_thickness && layersOf(base) != 2)
    std::cerr << "measure_cell: the image shows a zona, and " << arguments.scene
              << " has none: take a scene of two layers\n";
  return withMeasuredSize(base, cell);
}

int run(int argc, char** argv) {
  const std::optional<MeasureCellArguments> parsed = parseMeasureCellArguments(argc, argv);
  if (!parsed) return kFound;  // the help
  const MeasureCellArguments& arguments = *parsed;
  if (!arguments.out.empty()) requireWritableFolder(fs::absolute(arguments.out).parent_path());
  std::string warning;
  arguments.vision.pixelSize({0, 0}, warning);  // so that it is known to be missing before the search
  SharpestPlane search(arguments.vision.tracker, arguments.vision.secondEye());
  addImages(arguments.input, search);
  const CellPlane& plane = *search.best();
  const double pixel_size = arguments.vision.pixelSize({plane.image.cols, plane.image.rows}, warning);
  if (!warning.empty()) std::cerr << "measure_cell: " << warning << '\n';
  printPlane(plane, search);
  if (!arguments.overlay.empty()) writeOverlay(arguments.overlay, plane);
  printOthers(plane.view.cell, pixel_size);
  CellReadings readings(1);
  readings.add(plane.view);
  std::string reason;
  const std::optional<CellMeasurement> cell = readings.measure(1, pixel_size, reason);
  if (!cell) {
    printUncertain(plane.view.cell, pixel_size);
    flushStandardOutput();
    return kNotFound;
  }
  printLengths(*cell, plane);
  if (!arguments.scene.empty() && hasUnseenZona(loadYamlMap(arguments.scene), *cell)) {
    flushStandardOutput();
    std::cerr << "measure_cell: " << arguments.scene << ": " << kUnseenZona << '\n';
    return kNotFound;
  }
  if (!arguments.scene.empty()) {
    const YAML::Node node = sceneOf(arguments, *cell);
    const Scene scene = parseScene(node, arguments.scene + " with the measured lengths");
    if (!arguments.families.empty()) std::cout << "family: " << describeFamilyOf(scene, arguments.families) << '\n';
    if (!arguments.out.empty())
      writeFileAtomically(arguments.out, measuredSceneText(node, cell->describe(), arguments.scene));
  }
  flushStandardOutput();
  return kFound;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runProgram("measure_cell", [&] { return microinjection::run(argc, argv); });
}
