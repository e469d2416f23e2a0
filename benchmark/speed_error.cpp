// Error of the force against the time of one on-line force, for every model of the suite.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "benchmark/common/forked_case.h"
#include "benchmark/common/paper_mesh.h"
#include "benchmark/common/reference_scenes.h"
#include "benchmark/common/surrogate_scene.h"
#include "cell/family/family_cell.h"
#include "cell/mechanics/explicit_step.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/surface_grid.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr unsigned kTimeLimit = 240;  ///< s, of one row, where the machine is shared
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families";
constexpr char kPreparedScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";

struct Row {
  std::string model, element;
  std::size_t vertices = 0, tetrahedra = 0;  ///< corners of elements and elements, triangles in the section
  std::vector<double> errors;                ///< of the size of the force, relative, at each depth
  std::vector<double> times;                 ///< us, of a call or of a batch's calls

  std::string text() const {
    std::vector<double> found;
    std::copy_if(errors.begin(), errors.end(), std::back_inserter(found), [](double error) { return error == error; });
    if (found.size() < errors.size()) {
      std::cerr << model << ' ' << element << ' ' << tetrahedra << ": no solution at " << errors.size() - found.size()
                << " of " << errors.size() << " depths\n";
    }
    const double largest = found.empty() ? kNan : *std::max_element(found.begin(), found.end());
    char line[300];
    std::snprintf(line, sizeof(line), "%s,%s,%zu,%zu,%.5f,%.5f,%.4g,%.4g\n", model.c_str(), element.c_str(), vertices,
                  tetrahedra, quantile(found, 0.5), largest, quantile(times, 0.5), quantile(times, 0.99));
    return line;
  }
};

double error(double force, const ReferenceScene::Point& point) { return std::abs(force / point.force - 1); }

/// A needle that goes in and out: there and back in 2 `steps` calls, m.
double depthOf(int call, int steps, double deepest) {
  const int at = call % (2 * steps);
  return deepest * (at < steps ? at + 1 : 2 * steps - 1 - at) / steps;
}

Row rowOf(const std::string& model, const PaperCell& cell) {
  return {model, "p1", cell.mesh.vertices.size(), cell.mesh.tetrahedra.size(), {}, {}};
}

/// One force: the equilibrium at the needle's next place, a fiftieth of the way to the deepest from
/// the last one.
std::string quasiStatic(const std::string& model, const ReferenceScene& scene, const PaperMesh& mesh) {
  const PaperCell cell = makePaperCell(scene.scene, mesh);
  Row row = rowOf(model, cell);
  P1QuasiStatic solver(scene.scene, cell);
  double deepest = 0;
  for (const ReferenceScene::Point& point : scene.points) {
    row.errors.push_back(error(solver.force(point.depth), point));
    if (!(row.errors.back() == row.errors.back())) break;
    deepest = point.depth;
  }
  row.errors.resize(scene.points.size(), kNan);
  double sum = solver.force(0);
  row.times = callTimes([&](int i) { sum += solver.force(depthOf(i, 50, deepest)); }, 1, 1000, 4, 100);
  return row.text();
}

/// Steps until the force stays within `share` of its last value, and all of them.
int settledAfter(const std::vector<double>& forces, double share) {
  int settled = static_cast<int>(forces.size());
  while (settled > 0 && std::abs(forces[settled - 1] - forces.back()) < share * std::abs(forces.back())) --settled;
  return settled;
}

/// One force: one time step of equation (13) with the cell's mass (Table I: 1000 kg/m^3), none
/// added. Its error is that of the force it comes to rest at ("to rest": with the time until then
/// after a move of 0.25 um), damped critically for a shear wave of two diameters: the quasi-static
/// one.
std::string explicitDynamics(const ReferenceScene& scene, const PaperMesh& mesh) {
  constexpr int kRamp = 200;
  const PaperCell cell = makePaperCell(scene.scene, mesh);
  Row row = rowOf("st_venant_kirchhoff_disc explicit step", cell);
  const MaterialConfig& material = scene.scene.cell.material();
  ExplicitStepConfig config;
  config.lame = Lame::from(material.young_modulus, material.poisson_ratio);
  config.damping = 2 * M_PI * std::sqrt(config.lame.mu / config.density) / scene.scene.cell.diameter();
  config.held = cell.held;
  config.tip = cell.tip;
  ExplicitStep dynamics(cell.mesh, config);
  const int steps = static_cast<int>(150 / config.damping / dynamics.timeStep());  // slow modes creep
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  std::vector<double> forces;
  for (const ReferenceScene::Point& point : scene.points) {
    forces.clear();
    const double from = tip.z();
    for (int i = 1; i <= steps + kRamp; ++i) {
      tip.z() = from + (-point.depth - from) * std::min(1.0, i / static_cast<double>(kRamp));
      dynamics.step(tip);
      forces.push_back(dynamics.force().z());
    }
    row.errors.push_back(error(dynamics.force().z(), point));
  }
  const int settled = settledAfter(forces, 0.01);
  row.times = callTimes([&](int) { dynamics.step(tip); }, 10, 1000, 2, 100);
  std::fprintf(stderr,
               "explicit, %zu tetrahedra: step %.3g us of dynamics; to within 1 %% of rest after a move of "
               "%.2g um: %d steps, %.3g us of dynamics, %.3g ms of CPU\n",
               row.tetrahedra, 1e6 * dynamics.timeStep(),
               1e6 * (scene.points.back().depth - scene.points.end()[-2].depth), settled,
               1e6 * settled * dynamics.timeStep(), 1e-3 * settled * quantile(row.times, 0.5));
  Row rest = row;
  rest.model = "st_venant_kirchhoff_disc explicit to rest";
  for (double& time : rest.times) time *= settled;
  return row.text() + rest.text();
}

/// One force: the equilibrium at the next depth of the reference.
template <int Dim>
std::string converging(const ReferenceScene& scene, const std::string& element, double level, double deepest) {
  QuadraticMesh<Dim> mesh = makeSceneMesh<Dim>(scene.scene, level);
  Row row{scene.name + (Dim == 2 ? " axisymmetric" : " spatial"),
          element,
          static_cast<std::size_t>(mesh.vertex_count),
          mesh.elements.size(),
          {},
          {}};
  CellProblem<Dim> problem(scene.scene, std::move(mesh), elementKind(element));
  bool solved = true;
  for (const ReferenceScene::Point& point : scene.points) {
    if (point.depth > deepest) break;
    double force = kNan;
    const auto solve = [&](int) {
      const IndentationSolution solution = problem.solve({0, 0, -point.depth});
      solved = solution.converged;
      force = solved ? solution.force.z() : kNan;
    };
    if (solved) row.times.push_back(callTimes(solve, 1, 1, 0).front());
    row.errors.push_back(error(force, point));
  }
  return row.text();
}

/// One force: with its stiffness, at the needle's next place.
std::string prepared(const ReferenceScene& scene, const char* from, const std::shared_ptr<const SurrogateData>& cell) {
  Row row{scene.name + from, "energy", static_cast<std::size_t>(SurfaceGrid::standard().nodeCount()), 0, {}, {}};
  SurrogateContact contact(scene.scene, cell);
  const double top = scene.scene.radius();
  contact.step({0, 0, top + 1e-9});
  for (const ReferenceScene::Point& point : scene.points) {
    if (point.depth <= cell->range.depth) {
      row.errors.push_back(error(contact.step({0, 0, top - point.depth}).force.z(), point));
    }
  }
  contact.reset();
  double sum = 0;
  const auto step = [&](int i) { sum += contact.step({0, 0, top - depthOf(i, 500, cell->range.depth)}).force.z(); };
  row.times = callTimes(step, 20, 5000, 2);
  return row.text();
}

/// The cube [0, 1]^3 in n^3 cubes of six tetrahedra each.
TetMesh cube(int n) {
  constexpr int kWays[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  TetMesh mesh;
  const auto vertex = [n](const std::array<int, 3>& at) { return at[0] + (n + 1) * (at[1] + (n + 1) * at[2]); };
  for (int v = 0; v < (n + 1) * (n + 1) * (n + 1); ++v) {
    const Eigen::Vector3i at(v % (n + 1), v / (n + 1) % (n + 1), v / (n + 1) / (n + 1));
    mesh.vertices.emplace_back(at.cast<double>() / n);
  }
  for (int c = 0; c < 6 * n * n * n; ++c) {
    std::array<int, 3> corner = {c / 6 % n, c / 6 / n % n, c / 6 / (n * n)};
    std::array<int, 4> tetrahedron = {vertex(corner), 0, 0, 0};
    for (int step = 0; step < 3; ++step) {
      ++corner[kWays[c % 6][step]];
      tetrahedron[step + 1] = vertex(corner);
    }
    if (c % 6 >= 3) std::swap(tetrahedron[1], tetrahedron[2]);
    mesh.tetrahedra.push_back(tetrahedron);
  }
  return mesh;
}

/// One force: of all vertices of a cube, the kernel alone. The smallest of blocks of calls is what
/// the machine can do when nobody else is on it.
std::string kernel(int n, InstructionSet set, bool listed) {
  const TetMesh mesh = cube(n);
  StVenantKirchhoffForce force(mesh, Lame::from(17.9e3, 0.49), set);
  std::vector<double> positions, forces(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int k = 0; k < 3; ++k) positions.push_back(vertex[k] * (1 + 0.01 * vertex[(k + 1) % 3]));
  }
  Row row{"kernel", "p1", mesh.vertices.size(), mesh.tetrahedra.size(), {}, {}};
  const int batch = std::max(1, static_cast<int>(20000 / mesh.tetrahedra.size()));
  row.times = callTimes([&](int) { force.evaluate(positions.data(), forces.data()); }, batch, 2000, 2, 100);
  const double scale = 1e3 / static_cast<double>(mesh.tetrahedra.size());
  std::fprintf(stderr, "kernel, %s, %zu tetrahedra: median %.2f, least %.2f ns a tetrahedron\n",
               instructionSetName(set).c_str(), mesh.tetrahedra.size(), scale * quantile(row.times, 0.5),
               scale * quantile(row.times, 0));
  return listed ? row.text() : "";
}

class Table {
 public:
  Table() { std::cout << text_; }

  void add(const std::function<std::string()>& work) {
    const ForkedCase outcome = runForked(work, kTimeLimit);
    if (!outcome.failure.empty()) std::cerr << "the row after the last one: " << outcome.failure << '\n';
    std::cout << outcome.output << std::flush;
    text_ += outcome.output;
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_ =
      "model,element,vertices,tetrahedra,force_error_median,force_error_max,time_us_median,time_us_p99\n";
};

ReferenceScene referenceScene(const std::string& name) {
  for (const ReferenceScene& scene : referenceScenes()) {
    if (scene.name == name) return scene;
  }
  throw std::logic_error(name + ": no such reference");
}

void addLinear(Table& table) {
  const ReferenceScene linear = referenceScene("linear_disc"), disc = referenceScene("neo_hookean_disc"),
                       paper = stVenantKirchhoffScene();
  for (const PaperMesh& mesh : paperMeshes()) {
    table.add([&] { return quasiStatic("linear_disc", linear, mesh); });
    table.add([&] { return quasiStatic("st_venant_kirchhoff_disc quasi-static", paper, mesh); });
    table.add([&] { return explicitDynamics(paper, mesh); });
    table.add([&] { return quasiStatic("neo_hookean_disc live", disc, mesh); });
  }
}

void addConverging(Table& table) {
  const ReferenceScene disc = referenceScene("neo_hookean_disc"), hemisphere = referenceScene("hemisphere_sticking");
  for (const std::string& element : elementNames()) {
    for (int level = 0; level <= 3; ++level) table.add([&] { return converging<2>(disc, element, level, 5e-6); });
  }
  for (int level = 0; level <= 1; ++level) table.add([&] { return converging<2>(hemisphere, "p2_p0", level, 20e-6); });
  for (const char* element : {"mini", "p1_p1", "p2_p0", "p2_p1"}) {
    table.add([&] { return converging<3>(disc, element, -0.5, 5e-6); });
  }
  table.add([&] { return converging<3>(disc, "p2_p0", 0, 5e-6); });
  table.add([&] { return converging<3>(hemisphere, "p2_p0", -1, 10e-6); });
  table.add([&] { return converging<3>(hemisphere, "p2_p0", -0.5, 5e-6); });
}

std::string table() {
  Table table;
  const std::vector<InstructionSet> sets = supportedInstructionSets();
  for (const InstructionSet set : sets) {
    for (int n : {4, 9, 16, 26}) table.add([&] { return kernel(n, set, set == sets.back()); });
  }
  table.add([] {
    const auto cell = std::make_shared<const SurrogateData>(surrogateScene(loadScene(kPreparedScene), kPreparedScene));
    return prepared(referenceScene("hemisphere_sticking"), " prepared", cell);
  });
  table.add([] {
    std::string reason;
    const auto member = findFamilyCell(kFamilies, loadScene(kPreparedScene), reason);
    if (!member) throw std::runtime_error(reason);
    return prepared(referenceScene("hemisphere_sticking"), " family", member->data);
  });
  addLinear(table);
  addConverging(table);
  return table.text();
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv, "speed_error: error of the force against the CPU time of one on-line force", microinjection::table);
}
