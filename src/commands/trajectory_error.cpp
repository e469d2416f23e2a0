// Compares the predicted force of a recorded session with the full solution along the same path;
// see --help.

#include <boost/program_options.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/median.h"
#include "base/output_files.h"
#include "base/standard_output.h"
#include "base/text_table.h"
#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

/// Sample of a recorded session in which the tip touched the cell.
struct ContactSample {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< m, in the world
  double axial_force = 0;                         ///< N, predicted, along the pipette
};

/// Null: the table has no such column.
const TextTable::Column* columnOf(const TextTable& table, const std::string& title) {
  for (const TextTable::Column& column : table.columns) {
    if (column.title == title) return &column;
  }
  return nullptr;
}

const std::vector<double>& numbersOf(const TextTable& table, const std::string& title) {
  const TextTable::Column* column = columnOf(table, title);
  if (!column) throw ConfigError(table.path + ": has no column " + title);
  if (!column->text.empty())
    throw ConfigError(table.path + ", line " + std::to_string(column->text_line) + ": '" + column->text +
                      "' is not a number");
  return column->values;
}

/// Ends the contact at its deepest point.
void cutAtDeepest(std::vector<ContactSample>& contact) {
  const auto deepest = std::min_element(contact.begin(), contact.end(),
                                        [](const auto& a, const auto& b) { return a.tip.z() < b.tip.z(); });
  if (deepest != contact.end()) contact.erase(deepest + 1, contact.end());
}

/// Ends the contact at its largest force.
void cutAtPuncture(std::vector<ContactSample>& contact) {
  const auto largest = std::max_element(contact.begin(), contact.end(),
                                        [](const auto& a, const auto& b) { return a.axial_force < b.axial_force; });
  if (largest != contact.end()) contact.erase(largest + 1, contact.end());
}

double depth(const std::vector<ContactSample>& path) {
  return path.empty() ? 0 : path.front().tip.z() - path.back().tip.z();
}

/// The longest indentation in a session's table (force_depth.csv of the session recorder), from
/// first contact to the deepest point of that contact. When a layer fails (optional column
/// `punctured`), the path ends at the largest force before, because the cell reports a puncture
/// some milliseconds late. Throws ConfigError when the file cannot be read, lacks a column or has
/// no contact.
std::vector<ContactSample> readIndentationPath(const std::string& path) {
  const TextTable table = readTextTable(path);
  const std::vector<double>& x = numbersOf(table, "tip_x_m");
  const std::vector<double>& y = numbersOf(table, "tip_y_m");
  const std::vector<double>& z = numbersOf(table, "tip_z_m");
  const std::vector<double>& force = numbersOf(table, "predicted_axial_N");
  const std::vector<double>& in_contact = numbersOf(table, "in_contact");
  const TextTable::Column* punctured = columnOf(table, "punctured");
  std::vector<ContactSample> longest, contact;
  const auto end = [&] {
    cutAtDeepest(contact);
    if (depth(contact) > depth(longest)) longest = contact;
    contact.clear();
  };
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (punctured && punctured->values[row] == 1) {
      cutAtPuncture(contact);
      break;  // the cell stays punctured
    }
    if (in_contact[row] != 1) {
      end();
      continue;
    }
    if (std::isnan(force[row]) || std::isnan(z[row])) continue;
    contact.push_back({{x[row], y[row], z[row]}, force[row]});
  }
  end();
  if (longest.size() < 2) throw ConfigError(path + ": the tip never went into the cell");
  return longest;
}

/// `count` samples of an indentation, evenly in depth; the last is the deepest.
std::vector<ContactSample> thinOut(const std::vector<ContactSample>& path, int count) {
  std::vector<ContactSample> result;
  const double top = path.front().tip.z(), all = depth(path);
  for (const ContactSample& sample : path) {
    const double wanted = all * static_cast<double>(result.size() + 1) / count;
    if (static_cast<int>(result.size()) < count && top - sample.tip.z() >= wanted * (1 - 1e-12)) {
      result.push_back(sample);
    }
  }
  return result;
}

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
  Arguments arguments;
  po::options_description options;
  options.add_options()("help", "this text")("scene", po::value(&arguments.scene), "scene file of the session (YAML)")(
      "session", po::value(&arguments.session), "force_depth.csv of the session")(
      "points", po::value(&arguments.points)->default_value(arguments.points), "points compared, evenly in depth")(
      "level", po::value(&arguments.level)->default_value(arguments.level),
      "refinement of the full solution's mesh; -1 is that of `prepare`, finer ones are larger")(
      "csv", po::value(&arguments.csv), "file to write the table to as well");
  po::variables_map values;
  if (!readCommandLine(wordsOf(argc, argv), options, kHelp, values)) return kDone;
  if (arguments.scene.empty() || arguments.session.empty()) throw ConfigError("--scene and --session are required");
  if (arguments.points < 1) throw ConfigError("--points: must be 1 or more");
  OutputFiles()
      .reads("--scene", arguments.scene)
      .reads("--session", arguments.session)
      .writes("--csv", arguments.csv)
      .check();
  return compare(arguments);
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  return runProgram(
      "trajectory_error", [&] { return run(argc, argv); }, kFailed);
}
