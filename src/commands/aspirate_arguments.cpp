#include "commands/aspirate_arguments.h"

#include <boost/program_options.hpp>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "commands/number_arguments.h"

namespace microinjection {
namespace {

constexpr char kAspirateHelp[] =
    R"(aspirate: the tongue that suction draws from a cell into the holding pipette, solved to a given tolerance.

Usage: aspirate --scene FILE [--pressures P1,P2,...] [--tolerance T] [--csv FILE]

The scene's holding pipette has a mouth (holding_pipette/mouth). The cell is solved in its section, without the needle,
on finer and finer meshes until two of them agree. One CSV row a pressure, in the order given:
  pressure_Pa,tongue_length_m,tongue_volume_m3,seal_radius_m,clamping_force_N,converged,error_estimate
tongue_length: from the plane of the lip's crest to the cell's furthest point in the bore; negative while that is outside.
tongue_volume: of the cell behind that plane, in the bore.
seal_radius: of the circle on which the cell lies on the lip; pressure times its area is what holds the cell.
clamping_force: of the lip on the cell, along the axis.
converged: 1, or 0 if finer meshes have no solution; stderr has the reason. A strong suction has none: the cell is drawn in
without end. error_estimate: relative error of the tongue's length, from the last two meshes.

Example:
  aspirate --scene config/cells/mouse_oocyte_held.yaml --pressures=-200,-500,-1000 --csv tongue.csv

Exit status: 0 all pressures converged; 2 bad usage or scene, or output that cannot be written (the message names it); 3 some
pressure did not converge (its row is written); 4 all converged, but some not to the --tolerance that was given.

Options)";

}  // namespace

std::optional<AspirateArguments> parseAspirateArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  AspirateArguments arguments;
  std::string pressures, tolerance;
  po::options_description options(kAspirateHelp, 118);
  options.add_options()("help", "this text")("scene", po::value(&arguments.scene),
                                             "scene file (YAML, SI units) with holding_pipette/mouth")(
      "pressures", po::value(&pressures),
      "in the bore, Pa, gauge, at most 0, separated by commas; default: the scene's own")(
      "tolerance", po::value(&tolerance), "largest relative error of the tongue's length; default 0.005")(
      "csv", po::value(&arguments.csv)->default_value("-"), "file to write; - is the standard output");
  po::variables_map values;
  if (!readLongOptions(wordsOf(argc, argv), options, values)) return std::nullopt;
  if (values.count("scene") == 0) throw ConfigError("--scene is missing: a scene file, see --help");
  OutputFiles().reads("--scene", arguments.scene).writes("--csv", arguments.csv).check();
  if (!pressures.empty()) {
    arguments.pressures = parseNumbers("pressures", pressures, "numbers <= 0 (Pa) separated by commas");
    for (const double pressure : arguments.pressures) {
      if (pressure > 0) throw ConfigError("--pressures = " + pressures + ": each must be <= 0 (Pa): suction");
    }
  }
  arguments.tolerance_given = !tolerance.empty();
  if (arguments.tolerance_given) arguments.config.tolerance = parsePositive("tolerance", tolerance, "");
  return arguments;
}

}  // namespace microinjection
