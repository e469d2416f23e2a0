// Time of a solution of the live cell against vertices, for each method of SymmetricSolver.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "cell/mechanics/equilibrium_system.h"
#include "cell/model/p1_cell.h"

namespace microinjection {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Method = SymmetricSolver::Method;

double cpuTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Median CPU time of a call, s.
double median(const std::function<void()>& call) {
  constexpr int kRepetitions = 9;
  std::vector<double> times;
  for (int i = 0; i < kRepetitions; ++i) {
    const double start = cpuTime();
    call();
    times.push_back(cpuTime() - start);
  }
  std::nth_element(times.begin(), times.begin() + kRepetitions / 2, times.end());
  return times[kRepetitions / 2];
}

struct Timing {
  double analyse = 0, factorise = 0, solve = 0;  ///< s; solve: three right-hand sides
  double entries = 0;                            ///< of the factor
};

Timing timeSolver(Method method, const Matrix& lower) {
  SymmetricSolver solver(method);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Ones(lower.rows(), 3);
  Eigen::MatrixXd solution;
  Timing timing;
  timing.analyse = median([&] { solver.analyse(lower); });
  timing.factorise = median([&] { solver.factorise(lower); });
  timing.solve = median([&] { solution = solver.solve(right); });
  timing.entries = solver.factorEntries();
  return timing;
}

/// Of the cell with what is held fixed and a disc that sticks to the tip.
Constraints makeConstraints(const P1Cell& cell) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Constraints constraints;
  constraints.entries.assign(cell.body()->stateSize(), Constraints::kFree);
  for (int k = 0; k < 3; ++k) {
    for (int v : cell.heldVertices()) constraints.entries[3 * v + k] = Constraints::kFixed;
    for (int v : cell.patchAt(cell.scene().radius() * up, up).vertices) {
      constraints.entries[3 * v + k] = Constraints::tip(k);
    }
    constraints.entries[cell.body()->tipEntry() + k] = Constraints::tip(k);
  }
  return constraints;
}

std::string measure(double size) {
  Scene scene;
  scene.mesh.size = size;
  const P1Cell cell(scene);
  const Constraints constraints = makeConstraints(cell);
  const Eigen::VectorXd undeformed = Eigen::VectorXd::Zero(cell.body()->stateSize());
  std::ostringstream rows;
  for (const auto& [method, name] : {std::pair(Method::kSimplicial, "simplicial"),
                                     {Method::kSupernodal, "supernodal"},
                                     {Method::kIndefinite, "indefinite"}}) {
    EquilibriumSystem system({cell.body()}, constraints, method);
    const double assemble = median([&] { system.assemble(undeformed); });
    const double whole = median([&] { system.factorise(undeformed); });
    const Timing timing = timeSolver(method, system.matrix());
    char row[200];
    std::snprintf(row, sizeof(row), "%zu,%zu,%s,%.0f,%.3f,%.3f,%.3f,%.3f,%.3f\n", cell.mesh().vertices.size(),
                  cell.mesh().tetrahedra.size(), name, timing.entries, 1e3 * timing.analyse, 1e3 * timing.factorise,
                  1e3 * timing.solve, 1e3 * assemble, 1e3 * whole);
    rows << row;
  }
  return rows.str();
}

std::string table() {
  std::string table =
      "vertices,tetrahedra,method,factor_entries,analyse_ms,factorise_ms,solve_3_ms,assemble_ms,assemble_and_condense_"
      "ms\n";
  std::cout << table;
  for (const double size : {20e-6, 15e-6, 12e-6, 9e-6, 7e-6}) {
    const std::string rows = measure(size);
    std::cout << rows << std::flush;
    table += rows;
  }
  return table;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv,
      "solver: CPU time of a solution of the live cell against vertices, for the methods of "
      "the sparse solver",
      microinjection::table);
}
