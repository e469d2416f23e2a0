#include "commands/indent_arguments.h"

#include <algorithm>
#include <boost/program_options.hpp>

#include "base/command_line.h"
#include "base/config_errors.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "commands/number_arguments.h"

namespace microinjection {
namespace {

constexpr char kIndentHelp[] =
    R"(indent: quasi-static force on a needle tip pushed into a cell, solved to a given tolerance.

Usage: indent --scene FILE --depths D1,D2,... [--tolerance T] [--lateral X,Y] [--csv FILE] [...]

The tip moves along -z from its contact with the undeformed cell at the scene's needle/offset (a disc: its centre).
With --withdraw it is then withdrawn, and the table continues with those depths: friction, adhesion, viscosity show.
The scene is solved on successively finer meshes until two of them agree. One CSV row a depth, in the order given:
  depth_m,force_x_N,force_y_N,force_z_N,wall_s,converged,error_estimate
force: of the cell on the needle, so force_z is positive when the cell is indented; nan without a solution.
wall_s: time of that row's solutions. converged: 1, or 0 if finer meshes have no solution; stderr has the reason.
error_estimate: relative error of the force, from the last two meshes; nan for the live model, whose error is unknown
(about 1 to 3, see doc/reference/benchmarks.md), and for the membrane.

Models:
  auto          axisymmetric where offset and lateral are 0, else spatial
  axisymmetric  the cell's section, in seconds
  spatial       in space
  live          the P1 tetrahedra of a live session (the scene's mesh keys), which lock; discs only
  membrane      an analytic point-load model of the zona pellucida (cell/biomembrane in the scene, with the modulus of the
                outermost material): F = k depth^3; it includes neither the inside's elasticity nor withdrawal
A scene of cell/model tensegrity has one model, its own (auto), and no error estimate: --tolerance, --element and --time
must be left out.

Example:
  indent --scene config/cells/mouse_oocyte.yaml --depths 1e-6,2e-6,5e-6 --tolerance 0.01 --csv force.csv

Exit status: 0 all depths converged; 2 bad usage or scene, or output that cannot be written (the message names it); 3 some
depth did not converge (its row is written); 4 all converged, but some depth not to the --tolerance that was given.

Options)";

std::vector<double> parseDepths(const std::string& text) {
  const std::string wanted = "numbers >= 0 (m) separated by commas";
  std::vector<double> depths = parseNumbers("depths", text, wanted);
  for (const double depth : depths) {
    if (depth < 0) throw ConfigError("--depths = " + text + ": each must be >= 0 (m)");
  }
  return depths;
}

Eigen::Vector2d parseLateral(const std::string& text) {
  const std::string wanted = "two numbers X,Y (m)";
  const std::vector<double> xy = parseNumbers("lateral", text, wanted);
  if (xy.size() != 2) throw ConfigError("--lateral = " + text + ": must be " + wanted);
  return {xy[0], xy[1]};
}

/// Index of a name. Throws ConfigError that lists all names.
std::size_t parseChoice(const std::string& option, const std::string& name, const std::vector<std::string>& names) {
  ConfigErrors errors;
  errors.requireOneOf(names, "--" + option, name);
  errors.throwAny();
  return std::find(names.begin(), names.end(), name) - names.begin();
}

struct OptionTexts {
  std::string depths, withdraw, lateral, model, element, tolerance, speed, hold, time;
};

void interpret(const OptionTexts& texts, IndentArguments& arguments) {
  arguments.indenting.depths = parseDepths(texts.depths);
  if (!texts.withdraw.empty()) {
    arguments.indenting.withdrawal = parseNumbers("withdraw", texts.withdraw, "numbers (m) separated by commas");
  }
  arguments.indenting.lateral = parseLateral(texts.lateral);
  if (!texts.speed.empty()) arguments.indenting.speed = parsePositive("speed", texts.speed, " (m/s)");
  arguments.indenting.hold = parsePositive("hold", texts.hold, " (s)", true);
  parseChoice("model", texts.model, indentModels());
  arguments.setModel(texts.model);
  parseChoice("element", texts.element, elementNames());
  arguments.converged.element = elementKind(texts.element);
  arguments.tolerance_given = !texts.tolerance.empty();
  if (arguments.tolerance_given) {
    arguments.converged.tolerance = parsePositive("tolerance", texts.tolerance, "");
  } else {
    arguments.converged.tolerance = defaultTolerance(loadScene(arguments.scene), arguments);
  }
  arguments.converged.time = parsePositive("time", texts.time, " (s)");
}

}  // namespace

const std::vector<std::string>& indentModels() {
  static const std::vector<std::string> names = {"auto", "axisymmetric", "spatial", "live", "membrane"};
  return names;
}

void IndentArguments::setModel(const std::string& name) {
  live = name == "live";
  membrane = name == "membrane";
  if (live || membrane) return;
  using Model = ConvergedForceConfig::Model;
  converged.model = name == "auto" ? Model::kAuto : name == "spatial" ? Model::kSpatial : Model::kAxisymmetric;
}

double defaultTolerance(const Scene& scene, const IndentArguments& arguments) {
  const bool on_axis = scene.needle.offset.isZero(0) && arguments.indenting.lateral.isZero(0);
  return on_axis && arguments.converged.model != ConvergedForceConfig::Model::kSpatial ? 0.005 : 0.03;
}

std::optional<IndentArguments> parseIndentArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  IndentArguments arguments;
  OptionTexts texts;
  po::options_description options(kIndentHelp, 118);
  options.add_options()("help", "this text")("scene", po::value(&arguments.scene),
                                             "scene file (YAML, SI units), for example config/cells/mouse_oocyte.yaml")(
      "depths", po::value(&texts.depths), "depths of the tip, m, separated by commas; each >= 0")(
      "withdraw", po::value(&texts.withdraw),
      "decreasing depths, m, for the withdrawal after the deepest; below 0: above the contact point")(
      "lateral", po::value(&texts.lateral)->default_value("0,0"),
      "X,Y: at every depth the tip has also moved by (X, Y), m, along a straight line to (X, Y, -depth)")(
      "model", po::value(&texts.model)->default_value("auto"),
      "auto, axisymmetric, spatial, live or membrane: see above")(
      "tolerance", po::value(&texts.tolerance),
      "largest relative error of the force; default 0.005 on the axis, 0.03 in space")(
      "element", po::value(&texts.element)->default_value("p2_p0"), "p1, mini, p1_p1, p2, p2_p0 or p2_p1")(
      "speed", po::value(&texts.speed),
      "of the tip, m/s, for viscoelastic cells; default: slow enough that they relax")(
      "hold", po::value(&texts.hold)->default_value("0"),
      "s that the tip rests at each depth before its force is computed")(
      "time", po::value(&texts.time)->default_value("600"), "s after which no third or finer mesh is started")(
      "csv", po::value(&arguments.csv)->default_value("-"), "file to write; - is the standard output");
  po::variables_map values;
  if (!readLongOptions(wordsOf(argc, argv), options, values)) return std::nullopt;
  if (values.count("scene") == 0) throw ConfigError("--scene is missing: a scene file, see --help");
  if (values.count("depths") == 0) throw ConfigError("--depths is missing: for example 1e-6,2e-6 (m), see --help");
  for (const auto& [name, value] : values) {
    if (!value.defaulted()) arguments.given[name] = value.as<std::string>();
  }
  OutputFiles().reads("--scene", arguments.scene).writes("--csv", arguments.csv).check();
  interpret(texts, arguments);
  return arguments;
}

}  // namespace microinjection
