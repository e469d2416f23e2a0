#include "commands/measure_cell_arguments.h"

#include <boost/program_options.hpp>
#include <iostream>

#include "base/command_line.h"
#include "base/config_errors.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "base/plausible.h"
#include "base/standard_output.h"
#include "vision/camera/image_file.h"

namespace microinjection {
namespace {

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

void readVision(const std::string& path, VisionConfig& vision) {
  ConfigReader reader = ConfigReader::ofFile(path);
  vision = VisionConfig::read(reader);
  reader.finish();
}

}  // namespace

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
  if (!config.empty()) readVision(config, arguments.vision);
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

}  // namespace microinjection
