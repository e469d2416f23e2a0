#include "cell/surrogate/surface_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cell/mesh/outer_surface.h"

namespace microinjection {
namespace {

constexpr int kAround = 32;           ///< nodes of a ring; even, for the mirror image
constexpr double kNarrowest = 0.012;  ///< rad, between rings at the contact point
constexpr double kWidest = 0.12;      ///< rad, on the far side
constexpr double kGrowth = 1.2;       ///< from ring to ring
constexpr double kOutside = -0.05;    ///< weight of a corner above which a node still belongs to a triangle
constexpr double kFlat = 1e-9;        ///< volume of triangle and centre, over the cubed radius: seen from the side

/// Angles (rad) of the rings from the contact point, between it and the far pole.
std::vector<double> rings() {
  std::vector<double> steps;
  double sum = 0;
  for (double step = kNarrowest; sum < M_PI; step = std::min(kWidest, kGrowth * step)) {
    steps.push_back(step);
    sum += step;
  }
  std::vector<double> result;
  double angle = 0;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    angle += steps[i] * M_PI / sum;
    result.push_back(angle);
  }
  return result;
}

}  // namespace

const SurfaceGrid& SurfaceGrid::standard() {
  static const SurfaceGrid grid;
  return grid;
}

SurfaceGrid::SurfaceGrid() {
  const std::vector<double> angles = rings();
  const int count = static_cast<int>(angles.size()), last = 1 + kAround * count;
  directions_.resize(3, last + 1);
  directions_.col(0) = Eigen::Vector3d::UnitZ();
  directions_.col(last) = -Eigen::Vector3d::UnitZ();
  mirrored_.assign(last + 1, 0);
  mirrored_[last] = last;
  const auto node = [](int ring, int k) { return 1 + ring * kAround + k % kAround; };
  for (int ring = 0; ring < count; ++ring) {
    for (int k = 0; k < kAround; ++k) {
      const double turn = 2 * M_PI * k / kAround;
      directions_.col(node(ring, k)) << std::sin(angles[ring]) * std::cos(turn),
          std::sin(angles[ring]) * std::sin(turn), std::cos(angles[ring]);
      mirrored_[node(ring, k)] = node(ring, kAround - k);
    }
  }
  for (int k = 0; k < kAround; ++k) {
    triangles_.emplace_back(0, node(0, k), node(0, k + 1));
    for (int ring = 0; ring + 1 < count; ++ring) {
      triangles_.emplace_back(node(ring, k), node(ring + 1, k), node(ring + 1, k + 1));
      triangles_.emplace_back(node(ring, k), node(ring + 1, k + 1), node(ring, k + 1));
    }
    triangles_.emplace_back(last, node(count - 1, k + 1), node(count - 1, k));
  }
}

Eigen::VectorXd SurfaceGrid::nodes(double radius, double angle) const {
  Eigen::Matrix3d turn;
  turn << std::cos(angle), 0, std::sin(angle), 0, 1, 0, -std::sin(angle), 0, std::cos(angle);
  const Eigen::Matrix3Xd turned = radius * (turn * directions_);
  return Eigen::Map<const Eigen::VectorXd>(turned.data(), turned.size());
}

GridInterpolation::GridInterpolation(const QuadraticMesh<3>& mesh, double angle, bool half) {
  const std::vector<int> outer = outerNodes(mesh);
  struct Cone {
    Eigen::Vector3i nodes;
    Eigen::Matrix3d inverse;  ///< from a direction to weights of the corners
  };
  std::vector<Cone> cones;
  for (const Eigen::Vector3i& t : outerTriangles(mesh)) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = mesh.nodes[outer[t[i]]].normalized();
    if (std::abs(corners.determinant()) < kFlat) continue;
    cones.push_back({{outer[t[0]], outer[t[1]], outer[t[2]]}, corners.inverse()});
  }
  const Eigen::VectorXd nodes = SurfaceGrid::standard().nodes(1, angle);
  for (Eigen::Index n = 0; n + 2 < nodes.size(); n += 3) {
    Eigen::Vector3d x = nodes.segment<3>(n);
    Place place{Eigen::Vector3i::Zero(), Eigen::Vector3d::Zero(), half && x.y() < 0 ? -1.0 : 1.0};
    x.y() *= place.side;
    double best = -std::numeric_limits<double>::infinity();
    for (const Cone& cone : cones) {
      Eigen::Vector3d weights = cone.inverse * x;
      if (!(weights.sum() > 0)) continue;  // on the far side
      weights /= weights.sum();
      if (!(weights.minCoeff() > best)) continue;
      best = weights.minCoeff();
      place.nodes = cone.nodes;
      place.weights = weights;
    }
    if (best < kOutside) throw std::invalid_argument("GridInterpolation: no triangle lies over a node of the grid");
    places_.push_back(place);
  }
}

Eigen::VectorXf GridInterpolation::displacement(const Eigen::VectorXd& state) const {
  Eigen::VectorXf result(3 * static_cast<Eigen::Index>(places_.size()));
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const Place& place = places_[n];
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) moved += place.weights[i] * state.segment<3>(3 * place.nodes[i]);
    moved.y() *= place.side;
    result.segment<3>(3 * static_cast<Eigen::Index>(n)) = moved.cast<float>();
  }
  return result;
}

}  // namespace microinjection
