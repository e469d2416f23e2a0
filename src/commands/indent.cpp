// Pushes a needle tip into a cell and writes the force at each depth; see --help.

#include <unistd.h>

#include <boost/program_options.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "cell/cell_model.h"
#include "cell/indentation.h"
#include "cell/scene.h"

namespace microinjection {
namespace {

constexpr int kConverged = 0, kBadUsage = 2, kNotConverged = 3;

constexpr char kHelp[] = R"(indent: quasi-static force on a needle tip pushed into a cell.

Usage: indent --scene FILE --depths D1,D2,... [--lateral X,Y] [--csv FILE]

The tip touches the upper surface of the undeformed cell where the scene's needle/offset says and is pushed along -z.
What lies under its disc sticks to it. One CSV row a depth, in the order given:
  depth_m,force_x_N,force_y_N,force_z_N,wall_s,converged
force: of the cell on the needle, so force_z is positive when the cell is indented; nan where there is no solution.
wall_s: time of that row's solution. converged: 1 or 0; the reason is printed on stderr.

Example:
  indent --scene config/cells/mouse_oocyte.yaml --depths 1e-6,2e-6,5e-6 --lateral 0,-1e-6 --csv force.csv

Exit status: 0 all depths converged; 2 bad usage or scene; 3 some depth did not converge (its row is written).

Options)";

struct Arguments {
  std::string scene;
  std::vector<double> depths;
  Eigen::Vector2d lateral = Eigen::Vector2d::Zero();
  std::string csv;
};

std::vector<double> parseNumbers(const std::string& option, const std::string& text, const std::string& wanted) {
  std::vector<double> numbers;
  std::istringstream items(text + ",");
  for (std::string item; std::getline(items, item, ',');) {
    std::size_t used = 0;
    double number = std::numeric_limits<double>::quiet_NaN();
    try {
      number = std::stod(item, &used);
    } catch (const std::exception&) {
      used = std::string::npos;
    }
    if (used != item.size() || !std::isfinite(number)) {
      throw ConfigError("--" + option + " = " + text + ": '" + item + "' is not a number; must be " + wanted);
    }
    numbers.push_back(number);
  }
  return numbers;
}

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

/// Empty when the help was asked for, and printed.
std::optional<Arguments> parseArguments(int argc, char** argv) {
  namespace po = boost::program_options;
  Arguments arguments;
  std::string depths, lateral;
  po::options_description options(kHelp, 118);
  options.add_options()("help", "this text")("scene", po::value(&arguments.scene),
                                             "scene file (YAML, SI units), for example config/cells/mouse_oocyte.yaml")(
      "depths", po::value(&depths),
      "depths of the tip below the undeformed surface, m, separated by commas; each >= 0")(
      "lateral", po::value(&lateral)->default_value("0,0"),
      "X,Y: at every depth the tip has also moved by (X, Y), m, along a straight line to (X, Y, -depth)")(
      "csv", po::value(&arguments.csv)->default_value("-"), "file to write; - is the standard output");
  // No short options, so that -1e-6 is a value.
  using Style = po::command_line_style::style_t;
  const int style = Style::allow_long | Style::long_allow_adjacent | Style::long_allow_next;
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(options).style(style).positional({}).run(), values);
  po::notify(values);
  if (values.count("help") != 0) {
    std::cout << options;
    return std::nullopt;
  }
  if (values.count("scene") == 0) throw ConfigError("--scene is missing: a scene file, see --help");
  if (values.count("depths") == 0) throw ConfigError("--depths is missing: for example 1e-6,2e-6 (m), see --help");
  arguments.depths = parseDepths(depths);
  arguments.lateral = parseLateral(lateral);
  return arguments;
}

struct Row {
  std::string csv;
  bool converged;
};

/// Pushed straight down, a deeper row continues from the last one, which lies on its way; any other starts afresh.
Row solveDepth(Indentation& indentation, double depth, const Eigen::Vector2d& lateral) {
  const auto start = std::chrono::steady_clock::now();
  const bool on_the_way = lateral.isZero(0) && -indentation.tipDisplacement().z() <= depth;
  if (!on_the_way) indentation.reset();
  const IndentationSolution solution = indentation.solve({lateral.x(), lateral.y(), -depth});
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d force = solution.converged ? solution.force : Eigen::Vector3d::Constant(nan);
  char row[200];
  std::snprintf(row, sizeof(row), "%.9g,%.9g,%.9g,%.9g,%.6f,%d\n", depth, force.x(), force.y(), force.z(), wall.count(),
                solution.converged ? 1 : 0);
  if (solution.converged) {
    std::fprintf(stderr, "indent: depth %.4g um: force (%.5g, %.5g, %.5g) uN, %.3f s\n", 1e6 * depth, 1e6 * force.x(),
                 1e6 * force.y(), 1e6 * force.z(), wall.count());
  } else {
    std::fprintf(stderr, "indent: depth %.4g um: not converged: %s; reached (%.4g, %.4g, %.4g) um\n", 1e6 * depth,
                 solution.reason.c_str(), 1e6 * solution.tip_displacement.x(), 1e6 * solution.tip_displacement.y(),
                 1e6 * solution.tip_displacement.z());
  }
  return {row, solution.converged};
}

int run(int argc, char** argv) {
  const std::optional<Arguments> parsed = parseArguments(argc, argv);
  if (!parsed) return kConverged;
  const Arguments& arguments = *parsed;
  const Scene scene = loadScene(arguments.scene);
  const auto cell = std::make_shared<const CellModel>(scene);
  const Eigen::Vector2d& offset = scene.needle.offset;
  const TipPatch patch = cell->patchAt({offset.x(), offset.y(), scene.radius()}, Eigen::Vector3d::UnitZ());
  std::fprintf(stderr, "indent: %s, %zu vertices, %zu tetrahedra, %zu vertices under the tip\n",
               scene.cell.material.model.c_str(), cell->mesh().vertices.size(), cell->mesh().tetrahedra.size(),
               patch.vertices.size());
  Indentation indentation(cell, patch);
  std::string table = "depth_m,force_x_N,force_y_N,force_z_N,wall_s,converged\n";
  bool all_converged = true;
  for (const double depth : arguments.depths) {
    const Row row = solveDepth(indentation, depth, arguments.lateral);
    table += row.csv;
    all_converged = all_converged && row.converged;
  }
  if (arguments.csv == "-") {
    std::cout << table << std::flush;
  } else {
    writeFileAtomically(arguments.csv, table);
  }
  return all_converged ? kConverged : kNotConverged;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  try {
    return microinjection::run(argc, argv);
  } catch (const std::exception& exception) {
    std::cerr << "indent: " << exception.what() << '\n';
    return microinjection::kBadUsage;
  }
}
