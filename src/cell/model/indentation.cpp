#include "cell/model/indentation.h"

#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

Constraints makeConstraints(const P1Cell& cell, const TipPatch& patch) {
  const LayeredBody<3>& body = *cell.body();
  Constraints constraints;
  constraints.entries.assign(body.stateSize(), Constraints::kFree);
  for (int k = 0; k < 3; ++k) {
    for (int v : cell.heldVertices()) constraints.entries[3 * v + k] = Constraints::kFixed;
    for (int v : patch.vertices) {
      int& entry = constraints.entries[3 * v + k];
      if (entry == Constraints::kFixed) {
        throw std::invalid_argument("the tip's patch and the held vertices overlap");
      }
      entry = Constraints::tip(k);
    }
    constraints.entries[body.tipEntry() + k] = Constraints::tip(k);
  }
  return constraints;
}

LoadPathConfig pathConfig(const P1Cell& cell) {
  LoadPathConfig config;
  config.length = cell.scene().cell.diameter();
  config.first_step = config.largest_step = config.length / 16;
  config.smallest_step = config.length * 1e-5;
  config.linear = cell.body()->isLinear();
  return config;
}

}  // namespace

Indentation::Indentation(std::shared_ptr<const P1Cell> cell, const TipPatch& patch)
    : cell_(std::move(cell)),
      problem_(cell_->body(), makeConstraints(*cell_, patch), pathConfig(*cell_),
               SymmetricSolver::Method::kSimplicial) {}

Eigen::VectorXd Indentation::surfaceDisplacement() const {
  const std::vector<int>& nodes = cell_->surface().mesh_vertices;
  Eigen::VectorXd result(3 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) result.segment<3>(3 * i) = state().segment<3>(3 * nodes[i]);
  return result;
}

}  // namespace microinjection
