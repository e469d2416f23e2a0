// Time of a solution against vertices, for the factorisations that were tried: ./dev bench solver.

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "bench/bench_main.h"
#include "cell/cell_model.h"
#include "mechanics/patch_system.h"

namespace microinjection {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// As mechanics/sparse_cholesky.h has it; the others order as their library does by default.
class NestedDissection : public Eigen::CholmodSimplicialLLT<Matrix, Eigen::Lower> {
 public:
  NestedDissection() {
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_NESDIS;
  }
};

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
  std::string solver;
  double analyse = 0, factorise = 0, solve = 0;  ///< s; solve: three right-hand sides
};

template <typename Solver>
Timing timeSolver(const std::string& name, const Matrix& lower) {
  Solver solver;
  const Eigen::MatrixXd right = Eigen::MatrixXd::Ones(lower.rows(), 3);
  Eigen::MatrixXd solution;
  Timing timing;
  timing.solver = name;
  timing.analyse = median([&] { solver.analyzePattern(lower); });
  timing.factorise = median([&] { solver.factorize(lower); });
  timing.solve = median([&] { solution = solver.solve(right); });
  return timing;
}

std::vector<Timing> timeSolvers(const Matrix& lower) {
  constexpr int kLower = Eigen::Lower;
  return {timeSolver<NestedDissection>("cholmod_simplicial_llt_nested_dissection", lower),
          timeSolver<Eigen::SimplicialLLT<Matrix, kLower>>("eigen_simplicial_llt", lower),
          timeSolver<Eigen::SimplicialLDLT<Matrix, kLower>>("eigen_simplicial_ldlt", lower),
          timeSolver<Eigen::CholmodSimplicialLLT<Matrix, kLower>>("cholmod_simplicial_llt", lower),
          timeSolver<Eigen::CholmodSimplicialLDLT<Matrix, kLower>>("cholmod_simplicial_ldlt", lower),
          timeSolver<Eigen::CholmodSupernodalLLT<Matrix, kLower>>("cholmod_supernodal_llt", lower)};
}

std::string measure(double size) {
  Scene scene;
  scene.mesh.size = size;
  const CellModel cell(scene);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  PatchSystem system(cell.body(), cell.heldVertices(), cell.patchAt(scene.radius() * up, up).vertices);
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * cell.body().vertexCount());
  system.factorise(u);
  const double whole = median([&] { system.factorise(u); });
  std::ostringstream rows;
  for (const Timing& timing : timeSolvers(system.matrix())) {
    char row[200];
    std::snprintf(row, sizeof(row), "%zu,%zu,%s,%.3f,%.3f,%.3f,%.3f\n", cell.mesh().vertices.size(),
                  cell.mesh().tetrahedra.size(), timing.solver.c_str(), 1e3 * timing.analyse, 1e3 * timing.factorise,
                  1e3 * timing.solve, 1e3 * whole);
    rows << row;
  }
  return rows.str();
}

std::string table() {
  std::string table = "vertices,tetrahedra,solver,analyse_ms,factorise_ms,solve_3_ms,assemble_and_condense_ms\n";
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
      argc, argv, "solver: CPU time of a solution against vertices, for the sparse Cholesky factorisations tried",
      microinjection::table);
}
