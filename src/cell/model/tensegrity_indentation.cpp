#include "cell/model/tensegrity_indentation.h"

#include <algorithm>
#include <utility>

#include "base/cpu_time.h"

namespace microinjection {
namespace {

constexpr double kLead = 0.03;  ///< s, about the duration of a solution

}  // namespace

std::vector<CellModel::Member> tensegrityMembers(const TensegrityStructure& structure, const Cables& cables,
                                                 const Eigen::VectorXd& state) {
  using Member = CellModel::Member;
  constexpr std::size_t kEvery = 4;  // sections between the points of a strut's line
  std::vector<Member> result;
  for (int strut = 0; strut < 6; ++strut) {
    const std::vector<Eigen::Vector3d> line = structure.strutLine(strut, state);
    const double force = structure.strutForce(strut, state);
    for (std::size_t from = 0; from + 1 < line.size();) {
      const std::size_t to = std::min(from + kEvery, line.size() - 1);
      result.push_back({Member::Kind::kStrut, line[from], line[to], force});
      from = to;
    }
  }
  for (int i = 0; i < cables.elementCount(); ++i) {
    const Cables::Cable& cable = cables.cable(i);
    const bool actin = structure.isActin(i);
    result.push_back({actin ? Member::Kind::kActin : Member::Kind::kIntermediate, structure.position(cable.a, state),
                      structure.position(cable.b, state), cables.tension(i, state)});
  }
  return result;
}

TensegrityIndentation::TensegrityIndentation(std::shared_ptr<const TensegrityStructure> structure,
                                             const TipPatch& patch)
    : loading_(std::move(structure), patch.vertices), clock_(loading_.structure().config().viscous(), kLead) {}

IndentationSolution TensegrityIndentation::solve(const Eigen::Vector3d& tip_displacement, double duration) {
  const double start = threadCpuTime();
  const LoadPath::Result result = loading_.advance(tip_displacement, duration);
  IndentationSolution solution;
  solution.converged = result.converged;
  solution.reason = result.reason;
  solution.tip_displacement = loading_.displacement();
  solution.force = loading_.force();
  solution.stiffness = loading_.stiffness();
  solution.smallest_jacobian = loading_.structure().struts().smallestJacobian(loading_.state());
  solution.newton_iterations = result.newton_iterations;
  solution.cpu_time = threadCpuTime() - start;
  return solution;
}

IndentationSolution TensegrityIndentation::follow(const TipMotion& move) {
  if (clock_.mustRestart(move)) reset();
  return solve(move.displacement, clock_.advance(move));
}

Eigen::VectorXd TensegrityIndentation::surfaceDisplacement() const {
  const TensegrityStructure& structure = loading_.structure();
  const std::vector<int>& nodes = structure.surface().mesh_vertices;
  Eigen::VectorXd result(3 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Index at = 3 * nodes[i];
    result.segment<3>(3 * i) = loading_.state().segment<3>(at) - structure.start().segment<3>(at);
  }
  return result;
}

std::vector<CellModel::Member> TensegrityIndentation::members() const {
  return tensegrityMembers(loading_.structure(), loading_.cables(), loading_.state());
}

}  // namespace microinjection
