// Error of the force on plain P1 tetrahedra against converged solutions: ./dev bench p1_locking.

#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/bench_main.h"
#include "cell/cell_model.h"
#include "cell/indentation.h"

namespace microinjection {
namespace {

/// Numbers of test/reference/NAME.csv, comments and the header left out.
std::vector<std::vector<double>> readReference(const std::string& name) {
  const std::string path = std::string(MICROINJECTION_SOURCE_DIR) + "/test/reference/" + name + ".csv";
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::vector<std::vector<double>> rows;
  bool header = true;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (!header) {
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
    }
    header = false;
  }
  return rows;
}

struct Point {
  double depth;  ///< m
  double force;  ///< N, converged
};

/// Depths at which there is a converged force at nu = 0.49, ascending.
std::vector<Point> referencePoints(const std::string& model) {
  std::vector<Point> points;
  if (model == "linear") {
    points.push_back({1e-6, 1e-6 * readReference("linear").at(1).at(1)});
  } else if (model == "neo_hookean") {
    for (const std::vector<double>& row : readReference("neo_hookean"))
      points.push_back({1e-6 * row[0], 1e-6 * row[1]});
  } else {
    // Elements of h = 3 um at the disc's edge; further columns are finer. Their differences are below 4 %.
    const std::vector<double> row = readReference("st_venant_kirchhoff").at(0);
    const double depths[] = {0.1e-6, 0.25e-6, 0.5e-6, 0.75e-6};
    for (int i = 0; i < 4; ++i) points.push_back({depths[i], 1e-6 * row.at(i + 1)});
    points.push_back({1e-6 * row.at(5), 1e-6 * row.at(6)});
  }
  return points;
}

struct Mesh {
  const char* name;
  double size;     ///< m
  double density;  ///< of the puncture zone
};

std::string measure(const Mesh& mesh, const std::string& model) {
  Scene scene;
  scene.cell.material.model = model;
  scene.mesh.size = mesh.size;
  scene.mesh.refinement.density = mesh.density;
  const auto cell = std::make_shared<const CellModel>(scene);
  Indentation indentation(cell, cell->patchAt({0, 0, scene.radius()}, Eigen::Vector3d::UnitZ()));
  std::string rows;
  for (const Point& point : referencePoints(model)) {
    const IndentationSolution solution = indentation.solve({0, 0, -point.depth});
    const double force = solution.converged ? solution.force.z() : std::numeric_limits<double>::quiet_NaN();
    char row[300];
    std::snprintf(row, sizeof(row), "%s,%zu,%zu,%s,%.4g,%.5g,%.5g,%.1f,%.1f\n", mesh.name, cell->mesh().vertices.size(),
                  cell->mesh().tetrahedra.size(), model.c_str(), 1e6 * point.depth, 1e6 * force, 1e6 * point.force,
                  100 * (force / point.force - 1), 1e3 * solution.cpu_time);
    rows += row;
    if (!solution.converged) break;
  }
  return rows;
}

std::string table() {
  std::string table = "mesh,vertices,tetrahedra,material,depth_um,force_uN,reference_uN,error_percent,cpu_ms\n";
  std::cout << table;
  const std::vector<Mesh> meshes = {{"uniform", 12e-6, 1},    {"uniform", 8e-6, 1},     {"uniform", 5e-6, 1},
                                    {"uniform", 4e-6, 1},     {"refined_5x", 20e-6, 5}, {"refined_5x", 16e-6, 5},
                                    {"refined_5x", 15e-6, 5}, {"refined_5x", 10e-6, 5}};
  for (const std::string& model : materialModels()) {
    for (const Mesh& mesh : meshes) {
      const std::string rows = measure(mesh, model);
      std::cout << rows << std::flush;
      table += rows;
    }
  }
  return table;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv, "p1_locking: error of the force on P1 tetrahedra at nu = 0.49 against test/reference",
      microinjection::table);
}
