#include "commands/identify_arguments.h"

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/command_line.h"
#include "base/config_errors.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "base/plausible.h"
#include "base/separated.h"
#include "base/worker_processes.h"
#include "commands/scene_law.h"

namespace microinjection {
namespace {

constexpr char kHelp[] = R"help(identify: which cell is it? Fits a recorded force to models of a cell.

Usage: identify --record FILE [--scene FILE] [--model M1,M2,...] [--out SCENE] [...]
       identify --point DEPTH,FORCE --reading-error E --scene FILE --model solution [...]
       identify --tongue FILE [--pixel-size M] --scene FILE [--out SCENE] [...]
       identify --record FILE --tongue FILE --scene FILE [--out SCENE] [...]

The record is a table: a line of column names, then numbers. Names and units are found by themselves: time_s,
"height (um)", force_nN, deflection_m, ... ; otherwise name them: --column force=Fz:uN. Signs, a sensor's offset and
drift, outliers and missing rows may be as they come. Only the way in is used.

Tongues are a table of pressures in the holding pipette and the lengths that they have drawn in, as images show them from
any fixed place: "pressure (kPa)", tongue_um, ... ; the scene has the mouth (holding_pipette/mouth). It takes seconds.
With --pixel-size the table names an image instead of each length, in the column `image`: a path, relative to the table.
The tongues are then measured in the images, from the mouth's end. Images in which none is sure are named and left out.
With a record of the same cell the two moduli are joined (model `both`, which is the first one then).

Models (each is fitted, and compared with the others):
  family    the converged force of the scene's cell; its modulus, and ratios that --free names; it is compared with
            cells that have other layers
  solution  the same for any scene of solids, solved as by `indent` to the record's depth, which takes a minute; also
            how it stiffens: --free ogden_exponent or gent_limit, with some minutes
  live      same by the P1 tetrahedra of a live session, which are too stiff
  hertz     a paraboloid on a half space, with a scene on a ball of the cell's size
  cone      Sneddon; needs --half-angle
  shell     a point load on a thin shell; needs a scene with a shell
  membrane  see `indent --model membrane`; needs cell/biomembrane in the scene

Every value has an interval of 95 %. Pairs that the record cannot tell apart are named.

Examples:
  identify --record curve.csv --scene config/cells/mouse_oocyte_zona.yaml --out my_cell.yaml
  identify --record afm.csv --model hertz --tip-radius 10e-6 --poisson-ratio 0.5
  identify --point 45e-6,7.5e-6 --reading-error 0.05 --scene config/cells/mouse_oocyte_pipette.yaml --model solution

Exit status: 0 the first model follows the record; 2 bad usage, or output that cannot be written; 3 the record holds no
contact, or the fit fails; 4 the first model does not follow the record, or another cell follows it clearly better: do
not use its values; 5 the record does not determine a value: its interval is open or empty.

Options)help";

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> items = separated(text);
  items.erase(std::remove(items.begin(), items.end(), ""), items.end());
  return items;
}

/// Throws ConfigError unless the value is above 0 and can be meant.
void requirePlausible(const PlausibleRange& range, const std::string& option, double value) {
  ConfigErrors errors;
  if (Range::positive().contains(value))
    range.require("--" + option, value, errors);
  else
    errors.require(false, "--" + option, value, "", "a number > 0");
  errors.throwAny();
}

/// The families that are installed with this program, or else those of the working directory.
std::string defaultFamilies() {
  const std::filesystem::path installed =
      std::filesystem::path(thisProgram()).parent_path().parent_path().parent_path() /
      "share/cell_microinjection/config/families";
  return std::filesystem::is_directory(installed) ? installed.string() : "config/families";
}

Drift parseDrift(const std::string& text) {
  if (text == "auto") return Drift::kAuto;
  if (text == "on") return Drift::kOn;
  if (text == "off") return Drift::kOff;
  throw ConfigError("--drift = " + text + ": must be auto, on or off");
}

void addColumn(const std::string& text, ForceCurveConfig& config) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw ConfigError("--column " + text + ": must be QUANTITY=NAME:UNIT");
  config.columns[text.substr(0, equals)] = text.substr(equals + 1);
}

constexpr PlausibleRange kDepthError{"m", {1e-12, 1e-3}};
constexpr PlausibleRange kReadingError{"", {1e-6, 1}};  // relative

MeasuredPoint parsePoint(const std::string& text, double reading_error, double depth_error) {
  MeasuredPoint point;
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%lf,%lf%n", &point.depth, &point.force, &used);
  if (read != 2 || static_cast<std::size_t>(used) != text.size()) {
    throw ConfigError("--point = " + text + ": must be two numbers DEPTH,FORCE (m, N)");
  }
  requirePlausible(plausible::kDepth, "point (DEPTH)", point.depth);
  requirePlausible(plausible::kForce, "point (FORCE)", point.force);
  requirePlausible(kReadingError, "reading-error", reading_error);
  if (!(std::isfinite(depth_error) && depth_error >= 0)) throw ConfigError("--depth-error: must be a number >= 0 (m)");
  if (depth_error > 0) requirePlausible(kDepthError, "depth-error", depth_error);
  point.reading_error = reading_error;
  point.depth_error = depth_error;
  return point;
}

/// Throws ConfigError for an option that tongues do not use.
void requireFitTongue(const IdentifyArguments& arguments, const boost::program_options::variables_map& values) {
  if (arguments.scene.empty()) throw ConfigError("--tongue: needs --scene, which has the mouth");
  if (!arguments.residuals.empty()) throw ConfigError("--residuals: must be left out with --tongue");
  if (!arguments.record.empty()) return;
  for (const auto& [name, value] : values) {
    const bool used = name == "tongue" || name == "scene" || name == "out" || name == "csv" || name == "column" ||
                      name == "pixel-size" || name == "vision";
    if (!value.defaulted() && !used && !value.empty())
      throw ConfigError("--" + name + ": must be left out with --tongue");
  }
}

/// Throws ConfigError for what none of the models has.
void readFree(const std::vector<std::string>& names, IdentifyArguments& arguments) {
  const auto fits = [&](const std::string& model) {
    return std::find(arguments.models.begin(), arguments.models.end(), model) != arguments.models.end();
  };
  if (!names.empty() && arguments.point) {
    throw ConfigError("--free: must be left out with --point, which gives the modulus only");
  }
  for (const std::string& name : names) {
    const bool material = freeMaterialParameters().count(name) != 0;
    if (!material && !fits("family")) {
      throw ConfigError("--free " + name + ": must be ogden_exponent or gent_limit, or a ratio with --model family");
    }
    if (!material) {
      arguments.free.push_back(name);
      continue;
    }
    if (!fits("solution") && !fits("live")) {
      throw ConfigError("--free " + name + ": no family and no formula has it; needs --model solution");
    }
    if (!arguments.tongue.empty()) {
      throw ConfigError("--free " + name +
                        ": must be left out with --tongue, whose modulus is that of the scene's own");
    }
    if (!arguments.free_material.empty()) {
      throw ConfigError("--free " + name + ": must be left out beside " + arguments.free_material);
    }
    arguments.free_material = name;
  }
}

/// The scene has the modulus of these.
bool isOfScene(const std::string& model) { return model == "family" || model == "solution" || model == "live"; }

}  // namespace

std::optional<IdentifyArguments> parseIdentifyArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  IdentifyArguments arguments;
  std::string models, free, point, vision, drift = "auto";
  std::vector<std::string> columns;
  double poisson_ratio = -1, reading_error = 0, depth_error = 0, pixel_size = 0;
  bool quick = false;
  po::options_description options(kHelp);
  auto add = options.add_options();
  add("help", "this text");
  add("record", po::value(&arguments.record), "file with the record");
  add("point", po::value(&point), "DEPTH,FORCE: one published point instead of a record, m, N; the contact is at 0");
  add("tongue", po::value(&arguments.tongue), "file of tongue lengths by suction, instead of a record or beside it");
  add("pixel-size", po::value(&pixel_size),
      "m of the specimen for a pixel: the table of --tongue names images, in which the tongues are measured");
  add("vision", po::value(&vision), "parameters of the search in these images, as config/vision.yaml");
  add("reading-error", po::value(&reading_error), "of the point's force, relative: half of its interval of 95 %");
  add("depth-error", po::value(&depth_error), "m, same, of the point's depth");
  add("scene", po::value(&arguments.scene), "file with the cell's sizes and the tip, SI units");
  add("model", po::value(&models),
      "models, the first one for --out; default: family,hertz with a scene, else hertz; not with --tongue");
  add("free", po::value(&free),
      "what to find, too: ratios of the family (core_modulus, shell_thickness, tip_radius, ...), or of a solution "
      "ogden_exponent or gent_limit, by which its material stiffens");
  add("prony", po::value(&arguments.identification.prony_terms)->default_value(0),
      "number of relaxation times to find");
  add("drift", po::value(&drift)->default_value("auto"), "of the sensor: auto, on or off");
  add("column", po::value(&columns),
      "QUANTITY=NAME:UNIT; QUANTITY time, position, deflection or force; pressure or tongue");
  add("position-of", po::value(&arguments.curve.position_of)->default_value("auto"),
      "whose the position is: tip, base of a lever that bends, or auto: by the column's name");
  add("spring-constant", po::value(&arguments.curve.spring_constant),
      "N/m, of the lever, where the record has no deflection");
  add("from", po::value(&arguments.curve.from), "first row that is used, as 120, or time, as 1.5s");
  add("to", po::value(&arguments.curve.to), "last one");
  add("segment", po::value(&arguments.curve.segment), "text of the column segment that is used; default: the approach");
  add("whole", po::bool_switch(&arguments.curve.whole), "use what is no way in, too");
  add("calibration-error", po::value(&arguments.identification.calibration_error)->default_value(0),
      "of a record's force as a whole, relative: half of its interval of 95 %");
  add("tip-radius", po::value(&arguments.geometry.tip_radius), "m, of the tip for hertz");
  add("half-angle", po::value(&arguments.geometry.half_angle), "rad, of the cone");
  add("poisson-ratio", po::value(&poisson_ratio), "of the formulas; default that of the scene, else 0.5");
  add("families", po::value(&arguments.families)->default_value(defaultFamilies()), "folder of the families' files");
  add("out", po::value(&arguments.out), "scene file to write, with what was found by the first model");
  add("residuals", po::value(&arguments.residuals), "CSV file to write: measured, fitted and their difference");
  add("csv", po::value(&arguments.csv), "CSV file to write: what was found by each model");
  add("no-intervals", po::bool_switch(&quick), "intervals from the curvature alone: quicker");
  po::variables_map values;
  if (!readCommandLine(wordsOf(argc, argv), options, "", values)) return std::nullopt;
  const bool records = !arguments.record.empty() || !arguments.tongue.empty();
  if (records + !point.empty() != 1) {
    throw ConfigError(
        "--record, --tongue or both, or else --point: one of them must be given, the file with the record");
  }
  if (!arguments.tongue.empty()) requireFitTongue(arguments, values);
  if (pixel_size != 0 && arguments.tongue.empty()) throw ConfigError("--pixel-size: needs --tongue");
  if (!vision.empty() && pixel_size == 0) throw ConfigError("--vision: needs --pixel-size");
  if (!point.empty()) {
    if (values.count("reading-error") == 0) throw ConfigError("--point: needs --reading-error");
    if (!arguments.residuals.empty()) throw ConfigError("--residuals: needs --record");
    arguments.point = parsePoint(point, reading_error, depth_error);
  }
  const std::vector<std::pair<std::string, PlausibleRange>> ranges = {{"tip-radius", plausible::kTipRadius},
                                                                      {"half-angle", plausible::kConeAngle},
                                                                      {"pixel-size", plausible::kPixelSize},
                                                                      {"spring-constant", plausible::kStiffness}};
  for (const auto& [option, range] : ranges) {
    if (values.count(option) != 0) requirePlausible(range, option, values[option].as<double>());
  }
  if (const double error = arguments.identification.calibration_error; error != 0) {
    if (arguments.record.empty()) throw ConfigError("--calibration-error: needs --record");
    requirePlausible(kReadingError, "calibration-error", error);
  }
  if (values.count("poisson-ratio") != 0 && !(poisson_ratio > -1 && poisson_ratio <= 0.5)) {
    throw ConfigError("--poisson-ratio = " + std::to_string(poisson_ratio) + ": must be in (-1, 0.5]");
  }
  if (const std::string& of = arguments.curve.position_of; of != "auto" && of != "tip" && of != "base")
    throw ConfigError("--position-of = " + of + ": must be tip, base or auto");
  if (arguments.identification.prony_terms < 0 || arguments.identification.prony_terms > 3) {
    throw ConfigError("--prony = " + std::to_string(arguments.identification.prony_terms) + ": must be 0 to 3");
  }
  if (!arguments.out.empty() && arguments.scene.empty()) throw ConfigError("--out: needs --scene, which it changes");
  OutputFiles()
      .reads("--record", arguments.record)
      .reads("--tongue", arguments.tongue)
      .reads("--vision", vision)
      .reads("--scene", arguments.scene)
      .reads("--families", arguments.families)
      .writes("--out", arguments.out)
      .writes("--residuals", arguments.residuals)
      .writes("--csv", arguments.csv)
      .check();
  if (pixel_size > 0) {
    arguments.vision = vision.empty() ? VisionConfig::standard() : VisionConfig::load(vision);
    arguments.vision->pixel_size = pixel_size;
  }
  arguments.geometry.poisson_ratio = poisson_ratio;
  arguments.models = split(models.empty() ? (arguments.scene.empty() ? "hertz" : "family,hertz") : models);
  if (arguments.models.empty()) throw ConfigError("--model = " + models + ": must name a model");
  readFree(split(free), arguments);
  if (!arguments.out.empty() && !isOfScene(arguments.models.front())) {
    throw ConfigError("--out: the first model is " + arguments.models.front() +
                      ": must be family, solution or live, whose modulus is that of the scene's cell");
  }
  arguments.identification.drift = parseDrift(drift);
  arguments.identification.intervals = !quick;
  for (const std::string& column : columns) addColumn(column, arguments.curve);
  return arguments;
}

}  // namespace microinjection
