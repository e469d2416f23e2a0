// Compares the predicted force of a recorded session with the full solution along the same path;
// see --help.

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/exit_status.h"
#include "base/median.h"
#include "base/output_files.h"
#include "base/standard_output.h"
#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/scene_mesh.h"
#include "commands/trajectory.h"

namespace microinjection {
namespace {

namespace po = boost::program_options;

constexpr char kHelp[] =
    R"(trajectory_error: difference between a session's predicted force and the full solution. Reads the indentation of
a recorded session (force_depth.csv), moves the tip of the converging model (P2-P0 tetrahedra in space) along the same
path, and prints the force of both. Takes a minute.

Usage: trajectory_error --scene FILE --session CSV [--points N] [--level L] [--csv FILE]

Exit status: 0 done; 2 bad usage, scene or session, or output that cannot be written; 3 the full solution did
not converge.

Options)";

struct Arguments {
  std::string scene, session, csv;
  int points = 6;
  double level = -0.5;
};

int compare(const Arguments& arguments) {
  Scene scene = loadScene(arguments.scene);
  scene.requireContinuum("a full solution in space");
  for (const Scene::Layer& layer : scene.cell.layers) {
    if (layer.material.viscoelasticity.empty()) continue;
    throw ConfigError("viscoelasticity of layer " + layer.name +
                      ": must be left out: the session's times are not used here");
  }
  const std::vector<ContactSample> path = readIndentationPath(arguments.session);
  scene.needle.offset = path.front().tip.head<2>();
  const auto contact = ContactFrame::at(scene, scene.needle.offset);
  if (!contact) throw ConfigError(arguments.session + ": the tip is beside the cell of " + arguments.scene);
  CellProblem<3> problem(scene, makeSceneMesh<3>(scene, arguments.level), ElementKind::kP2P0);
  std::string table = "depth_m,session_N,full_N,error\n";
  std::cout << table;
  flushStandardOutput();
  std::vector<double> errors;
  for (const ContactSample& sample : thinOut(path, arguments.points)) {
    const IndentationSolution full = problem.solve(sample.tip - contact->origin);
    if (!full.converged) throw std::runtime_error("the full solution is lost: " + full.reason);
    if (!(full.force.z() > 0)) continue;  // still above the mesh's first point of contact
    errors.push_back(std::abs(sample.axial_force / full.force.z() - 1));
    char row[160];
    std::snprintf(row, sizeof(row), "%.4g,%.5g,%.5g,%.4f\n", contact->origin.z() - sample.tip.z(), sample.axial_force,
                  full.force.z(), sample.axial_force / full.force.z() - 1);
    std::cout << row;
    flushStandardOutput();
    table += row;
  }
  if (errors.empty()) throw ConfigError(arguments.session + ": the tip hardly touched the cell");
  if (!arguments.csv.empty()) writeFileAtomically(arguments.csv, table);
  std::printf(
      "force error along the session's way in, against the full solution with %zu tetrahedra: median %.2g %%, "
      "largest %.2g %%\n",
      problem.body().mesh().elements.size(), 100 * upperMedian(errors),
      100 * *std::max_element(errors.begin(), errors.end()));
  flushStandardOutput();
  return 0;
}

int run(int argc, char** argv) {
  try {
    Arguments arguments;
    po::options_description options;
    options.add_options()("help", "this text")("scene", po::value(&arguments.scene),
                                               "scene file of the session (YAML)")(
        "session", po::value(&arguments.session), "force_depth.csv of the session")(
        "points", po::value(&arguments.points)->default_value(arguments.points), "points compared, evenly in depth")(
        "level", po::value(&arguments.level)->default_value(arguments.level),
        "refinement of the full solution's mesh; -1 is that of `prepare`, finer ones are larger")(
        "csv", po::value(&arguments.csv), "file to write the table to as well");
    po::variables_map values;
    po::store(po::command_line_parser(argc, argv).options(options).positional({}).run(), values);
    po::notify(values);
    if (values.count("help") != 0) {
      std::cout << kHelp << options;
      flushStandardOutput();
      return 0;
    }
    if (arguments.scene.empty() || arguments.session.empty()) throw ConfigError("--scene and --session are required");
    if (arguments.points < 1) throw ConfigError("--points: must be 1 or more");
    OutputFiles()
        .reads("--scene", arguments.scene)
        .reads("--session", arguments.session)
        .writes("--csv", arguments.csv)
        .check();
    return compare(arguments);
  } catch (const po::error& error) {
    std::cerr << "trajectory_error: " << error.what() << "; see --help\n";
    return kBadUsage;
  } catch (const UserError& error) {
    std::cerr << "trajectory_error: " << error.what() << '\n';
    return kBadUsage;
  } catch (const std::exception& error) {
    std::cerr << "trajectory_error: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) { return microinjection::run(argc, argv); }
