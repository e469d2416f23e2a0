#include "cell/mechanics/st_venant_kirchhoff_force.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include "cell/mechanics/p1_body.h"

namespace microinjection {
namespace {

using Edges = Eigen::Matrix3d;

/// Inserts two zeros between neighbouring bits of a number in 0..2^21 - 1.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// Tetrahedra in the order of their centres on Morton's curve.
std::vector<int> alongMortonCurve(const TetMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const double scale = 0.25 * ((1 << 21) - 1) / box.sizes().maxCoeff();
  std::vector<std::uint64_t> code;
  for (const auto& corners : mesh.tetrahedra) {
    Eigen::Vector3d sum = -4 * box.min();
    for (int vertex : corners) sum += mesh.vertices[vertex];
    const auto bits = (scale * sum).cast<std::uint64_t>();
    code.push_back(spread(bits[0]) | spread(bits[1]) << 1 | spread(bits[2]) << 2);
  }
  std::vector<int> order(mesh.tetrahedra.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return code[a] < code[b]; });
  return order;
}

/// The mesh's vertices in the order in which the sorted tetrahedra first use them.
std::vector<int> inOrderOfUse(const TetMesh& mesh, const std::vector<int>& tetrahedra) {
  std::vector<int> order;
  std::vector<char> seen(mesh.vertices.size(), 0);
  const auto use = [&](int vertex) {
    if (!seen[vertex]) order.push_back(vertex);
    seen[vertex] = 1;
  };
  for (int t : tetrahedra) std::for_each(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end(), use);
  for (int vertex = 0; vertex < static_cast<int>(mesh.vertices.size()); ++vertex) use(vertex);
  return order;
}

/// R of edge = Q R, with Q a rotation.
Eigen::Matrix3d triangularFactor(const Edges& edge) {
  const Eigen::Vector3d first = edge.col(0).normalized();
  const Eigen::Vector3d third = edge.col(0).cross(edge.col(1)).normalized();
  Eigen::Matrix3d Q;
  Q << first, third.cross(first), third;
  return (Q.transpose() * edge).triangularView<Eigen::Upper>();
}

void fill(const Edges& edge, double mu, TetrahedronBlock& block, int at) {
  const Eigen::Matrix3d R = triangularFactor(edge);
  const Eigen::Matrix3d U = R.triangularView<Eigen::Upper>().solve(Eigen::Matrix3d::Identity());
  const double entries[6] = {U(0, 0), U(0, 1), U(0, 2), U(1, 1), U(1, 2), U(2, 2)};
  for (int k = 0; k < 6; ++k) block.inverse[k][at] = entries[k];
  block.weight[at] = mu * R.diagonal().prod() / 6;
}

}  // namespace

StVenantKirchhoffForce::StVenantKirchhoffForce(const TetMesh& mesh, const Lame& lame)
    : StVenantKirchhoffForce(mesh, lame, supportedInstructionSets().back()) {}

StVenantKirchhoffForce::StVenantKirchhoffForce(const TetMesh& mesh, const Lame& lame, InstructionSet set)
    : set_(set), kernel_(tetrahedronKernel(set)), ratio_(lame.lambda / (2 * lame.mu)) {
  checkP1Body(mesh, lame);
  const std::vector<InstructionSet> supported = supportedInstructionSets();
  if (std::find(supported.begin(), supported.end(), set) == supported.end()) {
    throw std::invalid_argument("this machine has no " + instructionSetName(set));
  }
  const std::vector<int> tetrahedra = alongMortonCurve(mesh);
  order_ = inOrderOfUse(mesh, tetrahedra);
  std::vector<std::uint32_t> number(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) number[order_[i]] = static_cast<std::uint32_t>(i);
  constexpr std::size_t kSize = TetrahedronBlock::kSize;
  blocks_.resize((tetrahedra.size() + kSize - 1) / kSize);
  for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
    TetrahedronBlock& block = blocks_[i / kSize];
    const int at = static_cast<int>(i % kSize);
    fill(tetrahedronEdges(mesh, tetrahedra[i]), lame.mu, block, at);
    for (int a = 0; a < 4; ++a) block.vertex[at][a] = 4 * number[mesh.tetrahedra[tetrahedra[i]][a]];
  }
  positions_.resize(order_.size());
  forces_.resize(order_.size());
}

void StVenantKirchhoffForce::evaluate(const double* positions, double* forces) {
  const std::size_t count = order_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double* from = positions + 3 * static_cast<std::size_t>(order_[i]);
    positions_[i] = {from[0], from[1], from[2], 0};
    forces_[i] = {};
  }
  kernel_(blocks_.data(), blocks_.size(), ratio_, positions_.data(), forces_.data());
  for (std::size_t i = 0; i < count; ++i) {
    double* to = forces + 3 * static_cast<std::size_t>(order_[i]);
    for (int k = 0; k < 3; ++k) to[k] = forces_[i].value[k];  // copying 24 bytes at once may become a call
  }
}

}  // namespace microinjection
