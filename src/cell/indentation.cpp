#include "cell/indentation.h"

#include <ctime>

namespace microinjection {
namespace {

double threadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Indentation::Indentation(std::shared_ptr<const CellModel> cell, const TipPatch& patch)
    : cell_(std::move(cell)),
      path_(cell_->body(), cell_->heldVertices(), patch.vertices, cell_->scene().cell.diameter) {}

IndentationSolution Indentation::solve(const Eigen::Vector3d& tip_displacement) {
  const double start = threadTime();
  const EquilibriumPath::Result result = path_.advance(tip_displacement);
  IndentationSolution solution;
  solution.converged = result.converged;
  solution.reason = result.reason;
  solution.tip_displacement = path_.translation();
  solution.force = -path_.reaction();
  solution.stiffness = path_.stiffness();
  solution.smallest_jacobian = path_.smallestJacobian();
  solution.newton_iterations = result.newton_iterations;
  solution.cpu_time = threadTime() - start;
  return solution;
}

}  // namespace microinjection
