#include "cell/mesh/swept_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace microinjection {
namespace {

/// 1 below `from`, 0 above `to`, linear between, which has the smallest slope.
double fade(double x, double from, double to) { return 1 - std::clamp((x - from) / (to - from), 0.0, 1.0); }

/// Map that tilts the pole of a ball. Points are given by their distance from the centre, their
/// angle from the pole and their azimuth about the z axis.
class PoleMap {
 public:
  PoleMap(double radius, const SweepConfig& config)
      : azimuth_(config.pole_azimuth),
        tilt_(std::asin(config.pole_offset / radius)),
        disc_(config.disc_radius / radius),
        disc_angle_(std::asin(disc_)),
        near_(std::max({0.3, std::min(4 * disc_angle_, 0.8), 1.4 * disc_angle_})),
        far_(M_PI - std::asin(std::min(1.0, config.holding_radius / radius)) * 1.02) {}

  Eigen::Vector3d operator()(double distance, double angle, double turn) const {
    const double beta = turn;  // measured from the direction in which the pole moves
    const double alpha = disc_ > 0 && tilt_ > 0 ? angle * discStretch(angle, beta) : angle;
    const Eigen::Vector3d turned(std::sin(alpha) * std::cos(beta), std::sin(alpha) * std::sin(beta), std::cos(alpha));
    const Eigen::AngleAxisd bend(tilt_ * fade(angle, near_, far_), Eigen::Vector3d::UnitY());
    return distance * (Eigen::AngleAxisd(azimuth_, Eigen::Vector3d::UnitZ()) * (bend * turned));
  }

 private:
  /// Stretches angles, because a vertical disc's edge is not a circle about a tilted pole.
  double discStretch(double angle, double beta) const {
    return 1 + (discAngle(beta) / disc_angle_ - 1) * fade(angle, 1.2 * disc_angle_, near_);
  }

  /// Angle from the pole at which the vertical cylinder of the disc's radius intersects the unit
  /// sphere.
  double discAngle(double beta) const {
    const auto outside = [&](double alpha) {
      const double x = std::sin(alpha) * std::cos(beta) * std::cos(tilt_) - (1 - std::cos(alpha)) * std::sin(tilt_);
      const double y = std::sin(alpha) * std::sin(beta);
      return std::hypot(x, y) - disc_;
    };
    double low = 0, high = 0.5 * disc_angle_;
    while (outside(high) < 0 && high < M_PI / 2) high *= 1.2;
    for (int i = 0; i < 60; ++i) (outside(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  }

  double azimuth_, tilt_, disc_, disc_angle_, near_, far_;
};

/// Sweeps a section into vertices and tetrahedra.
class Sweep {
 public:
  Sweep(const QuadraticMesh<2>& section, const SweepConfig& config)
      : section_(section), segments_(config.segments), half_(config.half), map_(cellRadius(section), config) {
    for (std::size_t e = 0; e < section.elements.size(); ++e) {
      std::array<int, 3> corners;
      std::copy_n(section.elements[e].begin(), 3, corners.begin());
      const auto& edges = elementEdges<2>();
      for (std::size_t i = 0; i < edges.size(); ++i) {
        middles_[std::minmax(corners[edges[i][0]], corners[edges[i][1]])] = section.elements[e][3 + i];
      }
      std::sort(corners.begin(), corners.end());  // so that neighbouring prisms cut their common face alike
      for (int k = 0; k < segments_; ++k) addPrism(corners, k, section.layers[e]);
    }
  }

  QuadraticMesh<3> mesh() const {
    QuadraticMesh<3> mesh = makeQuadratic(mesh_, [this](int a, int b) { return middle(a, b); });
    if (half_) dropCut(mesh);
    return mesh;
  }

 private:
  static double cellRadius(const QuadraticMesh<2>& section) {
    double radius = 0;
    for (const Eigen::Vector2d& node : section.nodes) radius = std::max(radius, node.norm());
    return radius;
  }

  bool onAxis(int node) const { return section_.nodes[node][0] == 0; }

  /// Position of a section's node, m, swept by a number of segments.
  Eigen::Vector3d position(int node, double turn) const {
    const Eigen::Vector2d& rz = section_.nodes[node];
    const double whole = half_ ? M_PI : 2 * M_PI;
    Eigen::Vector3d x = map_(rz.norm(), rz.norm() == 0 ? 0 : std::atan2(rz[0], rz[1]), whole * turn / segments_);
    if (half_ && (turn == 0 || turn == segments_)) x.y() = 0;  // exactly in the plane
    return x;
  }

  /// Removes the faces in the plane of symmetry from the facets, because they are not on the
  /// surface.
  static void dropCut(QuadraticMesh<3>& mesh) {
    const auto cut = [&](const QuadraticMesh<3>::Facet& facet) {
      return std::all_of(facet.nodes.begin(), facet.nodes.begin() + 3,
                         [&](int node) { return mesh.nodes[node].y() == 0; });
    };
    mesh.facets.erase(std::remove_if(mesh.facets.begin(), mesh.facets.end(), cut), mesh.facets.end());
  }

  int vertex(int node, int turn) {
    const std::pair<int, int> key(node, onAxis(node) ? 0 : half_ ? turn : turn % segments_);
    const auto [entry, added] = index_.try_emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (added) {
      mesh_.vertices.push_back(position(node, key.second));
      origin_.push_back(key);
    }
    return entry->second;
  }

  void addPrism(const std::array<int, 3>& c, int k, int layer) {
    const int a = vertex(c[0], k), b = vertex(c[1], k), d = vertex(c[2], k);
    const int e = vertex(c[0], k + 1), f = vertex(c[1], k + 1), g = vertex(c[2], k + 1);
    for (std::array<int, 4> t : {std::array<int, 4>{a, b, d, g}, {a, b, f, g}, {a, e, f, g}}) {
      std::array<int, 4> sorted = t;
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;  // collapsed on the axis
      mesh_.tetrahedra.push_back(t);
      mesh_.layers.push_back(layer);
      const int last = static_cast<int>(mesh_.tetrahedra.size()) - 1;
      if (tetrahedronVolume(mesh_, last) < 0) std::swap(mesh_.tetrahedra[last][0], mesh_.tetrahedra[last][1]);
    }
  }

  Eigen::Vector3d middle(int a, int b) const {
    const auto& [node_a, turn_a] = origin_[a];
    const auto& [node_b, turn_b] = origin_[b];
    const int node = node_a == node_b ? node_a : middles_.at(std::minmax(node_a, node_b));
    if (onAxis(node_a)) return position(node, turn_b);
    if (onAxis(node_b)) return position(node, turn_a);
    const bool across_seam = !half_ && std::abs(turn_a - turn_b) > 1;
    return position(node, 0.5 * (turn_a + turn_b + (across_seam ? segments_ : 0)));
  }

  const QuadraticMesh<2>& section_;
  int segments_;
  bool half_;
  PoleMap map_;
  std::map<std::pair<int, int>, int> middles_;  ///< midpoint node between two vertices of the section
  TetMesh mesh_;
  std::map<std::pair<int, int>, int> index_;  ///< vertex by node and turn
  std::vector<std::pair<int, int>> origin_;   ///< node and turn of each vertex
};

}  // namespace

QuadraticMesh<3> sweepSection(const QuadraticMesh<2>& section, const SweepConfig& config) {
  if (config.segments < 3) throw std::invalid_argument("a sweep has three segments at the least");
  if (config.half && config.pole_azimuth != 0) throw std::invalid_argument("half a sweep has its pole over the x axis");
  return Sweep(section, config).mesh();
}

}  // namespace microinjection
