#include "benchmark/common/reference_scenes.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace microinjection {
namespace {

/// Numbers of test/reference/NAME.csv, comments and the header left out; empty cells end a row.
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
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell.empty() ? 0 : std::stod(cell));
    }
    header = false;
  }
  return rows;
}

/// Depth and force of a table in um and uN, to a depth that most meshes reach.
std::vector<ReferenceScene::Point> points(const std::string& name, std::size_t column, double deepest_um) {
  std::vector<ReferenceScene::Point> result;
  for (const std::vector<double>& row : readReference(name)) {
    if (row[0] <= deepest_um && column < row.size() && row[column] > 0) {
      result.push_back({1e-6 * row[0], 1e-6 * row[column]});
    }
  }
  return result;
}

Scene cell(const std::string& model) {
  Scene scene;
  scene.cell.material().model = model;
  return scene;
}

Scene hemisphere(const std::string& mode) {
  Scene scene = cell("neo_hookean");
  scene.needle.tip.shape = "hemisphere";
  scene.needle.contact.mode = mode;
  return scene;
}

}  // namespace

std::vector<ReferenceScene> referenceScenes() {
  Scene layered = cell("neo_hookean");
  layered.cell.layers = {{"zona_pellucida", 28e-6, {"neo_hookean", 17.9e3, 0.49}, 0},
                         {"cytoplasm", 24e-6, {"neo_hookean", 1e3, 0.49}, 0}};
  const double linear = 1e-6 * readReference("linear").at(1).at(1);  // nu = 0.49
  return {{"linear_disc", cell("linear"), {{1e-6, linear}}},
          {"neo_hookean_disc", cell("neo_hookean"), points("neo_hookean", 1, 10)},
          {"layered_disc", layered, points("layered", 1, 10)},
          {"hemisphere_sticking", hemisphere("sticking"), points("hemisphere", 3, 20)},
          {"hemisphere_sliding", hemisphere("sliding"), points("hemisphere", 1, 5)}};
}

ReferenceScene stVenantKirchhoffScene() {
  const std::vector<double> finest = readReference("st_venant_kirchhoff").back();
  return {"st_venant_kirchhoff_disc",
          cell("st_venant_kirchhoff"),
          {{0.1e-6, 1e-6 * finest.at(1)}, {0.25e-6, 1e-6 * finest.at(2)}, {0.5e-6, 1e-6 * finest.at(3)}}};
}

}  // namespace microinjection
