// Measures a cell in images and writes its scene; see --help.

#include <boost/program_options.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/command_line.h"
#include "base/config_errors.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "base/plausible.h"
#include "base/standard_output.h"
#include "cell/family/family_cell.h"
#include "cell/model/scene.h"
#include "vision/camera/folder_source.h"
#include "vision/camera/image_file.h"
#include "vision/camera/video_source.h"
#include "vision/measurement/cell_measurement.h"
#include "vision/measurement/measured_scene.h"
#include "vision/measurement/sharpest_plane.h"
#include "vision/measurement/vision_config.h"
#include "vision/track/overlay.h"

namespace microinjection {
namespace {

/// Command line of `measure_cell`.
struct MeasureCellArguments {
  std::string input;                               ///< image, folder or video
  VisionConfig vision = VisionConfig::standard();  ///< with the pixel size
  std::string scene;                               ///< file, from which `out` is written; empty: none
  std::string out;                                 ///< scene file to write; empty: none
  std::string overlay;                             ///< picture to write; empty: none
  std::string families;                            ///< folder; empty: none
};

constexpr char kHelp[] = R"(measure_cell: diameter and zona of a cell in images, and the scene file of that cell.

Usage: measure_cell INPUT --pixel-size M [--scene FILE --out FILE] [--overlay PICTURE] [--families FOLDER]

INPUT is an image, a stack (TIFF with several pages), a folder of images or a video. Of several images, the one is
measured in which the cell is the sharpest: a stack of planes needs no choice. An image out of focus gives a wrong diameter, which its interval leaves out.
It prints, a line each:
  image      name of the measured image, its number, and in how many images the cell was measured
  verdict    found, uncertain or not found, with the reason
  diameter, zona, offset    with half widths of 95 % intervals, which leave out the error of the pixel size;
             of an uncertain cell what was seen of diameter, zona and centre, without intervals
  polar body its direction from the cell's centre, from the image's x towards y (down), if it is sure
  family     with --scene and --families: the family that serves this cell without preparation, with the expected error
offset: of the cell's centre from the axis of the holding pipette, positive to the right, seen from shaft to mouth.

--out writes the scene of --scene with the measured lengths. Materials, needle and holding pipette stay those of --scene.
`indent --scene` and `session.launch cell:=` take the file.

Example:
  measure_cell stack/ --pixel-size 0.25e-6 --scene config/cells/mouse_oocyte_zona.yaml --out measured.yaml

Exit status: 0 found; 2 bad usage, or input or output that cannot be read or written (the message names it); 3 the cell
is not found or uncertain, or the scene has a zona and the image shows none: no scene is written.

)";

/// Returns nothing after printing the help. Throws ConfigError on bad usage.
std::optional<MeasureCellArguments> parseMeasureCellArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  MeasureCellArguments arguments;
  std::string config, calibration;
  double pixel_size = 0;
  po::options_description options("Options");
  auto add = options.add_options();
  add("help,h", "this text");
  add("input", po::value(&arguments.input)->value_name("PATH"),
      "image, stack, folder or video; the option's name may be left out");
  add("pixel-size", po::value(&pixel_size)->value_name("M"), "m of the specimen for a pixel");
  add("calibration", po::value(&calibration)->value_name("FILE"), "calibration with the pixel size, instead of it");
  add("config", po::value(&config)->value_name("FILE"), "parameters of the search, as config/vision.yaml");
  add("scene", po::value(&arguments.scene)->value_name("FILE"), "scene from which --out is written");
  add("out", po::value(&arguments.out)->value_name("FILE"), "scene file to write");
  add("overlay", po::value(&arguments.overlay)->value_name("FILE"),
      "picture to write: the measured image with what was found");
  add("families", po::value(&arguments.families)->value_name("FOLDER"),
      "folder of the families, such as config/families");
  po::variables_map given;
  if (!readCommandLine(wordsOf(argc, argv), options, kHelp, given, "input")) return std::nullopt;
  if (!config.empty()) arguments.vision = VisionConfig::load(config);
  if (!calibration.empty()) arguments.vision.calibration = calibration;
  ConfigErrors errors;
  errors.require(!arguments.input.empty(), "INPUT", "", "", "an image, a folder or a video");
  if (given.count("pixel-size") > 0) plausible::kPixelSize.require("--pixel-size", pixel_size, errors);
  errors.require(given.count("pixel-size") == 0 || calibration.empty(), "--calibration", calibration, "",
                 "left out with --pixel-size");
  errors.require(arguments.out.empty() || !arguments.scene.empty(), "--out", arguments.out, "",
                 "given with --scene, which has the materials");
  errors.require(arguments.families.empty() || !arguments.scene.empty(), "--families", arguments.families, "",
                 "given with --scene, which has the materials");
  errors.require(arguments.overlay.empty() || hasImageName(arguments.overlay), "--overlay", arguments.overlay, "",
                 "a name of an image, such as overlay.png");
  errors.throwAny();
  OutputFiles()
      .reads("INPUT", arguments.input)
      .reads("--calibration", calibration)
      .reads("--config", config)
      .reads("--scene", arguments.scene)
      .reads("--families", arguments.families)
      .writes("--out", arguments.out)
      .writes("--overlay", arguments.overlay)
      .check();
  if (pixel_size > 0) arguments.vision.pixel_size = pixel_size;
  // Without either one the calibration must be asked for: a file left from another microscope would go unnoticed.
  if (arguments.vision.pixel_size == 0 && arguments.vision.calibration.empty())
    throw ConfigError("--pixel-size is missing: must be given, or --calibration");
  return arguments;
}

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
