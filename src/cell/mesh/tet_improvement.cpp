#include "cell/mesh/tet_improvement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace microinjection {
namespace {

constexpr int kSweeps = 5;

/// First and last step of the search, and the largest displacement of a vertex, over the shortest
/// edge at the vertex.
constexpr double kFirstStep = 0.4, kLastStep = 0.01, kFarthest = 0.8;

class Improver {
 public:
  Improver(TetMesh& mesh, const std::vector<Mobility>& mobility, double target)
      : mesh_(mesh), mobility_(mobility), target_(target), start_(mesh.vertices), around_(mesh.vertices.size()) {
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      for (int vertex : mesh.tetrahedra[t]) around_[vertex].push_back(static_cast<int>(t));
      const double quality = radiusRatio(mesh, static_cast<int>(t));
      if (quality < target) bad_.emplace_back(quality, static_cast<int>(t));
    }
    std::sort(bad_.begin(), bad_.end());
  }

  /// One pass over the tetrahedra that were bad at the start, worst first. Tetrahedra that became
  /// bad later are not treated, because that would spread the damage of a sliver that cannot be
  /// improved. True when a vertex moved.
  bool sweep() {
    bool moved = false;
    for (const auto& [quality, tetrahedron] : bad_) {
      for (int vertex : mesh_.tetrahedra[tetrahedron]) {
        if (radiusRatio(mesh_, tetrahedron) < target_) moved = improve(vertex) || moved;
      }
    }
    return moved;
  }

 private:
  double worstAround(int vertex) const {
    double worst = std::numeric_limits<double>::infinity();
    for (int t : around_[vertex]) worst = std::min(worst, radiusRatio(mesh_, t));
    return worst;
  }

  double shortestEdge(int vertex) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (int t : around_[vertex]) {
      for (int other : mesh_.tetrahedra[t]) {
        const double edge = (start_[other] - start_[vertex]).norm();
        if (other != vertex) shortest = std::min(shortest, edge);
      }
    }
    return shortest;
  }

  /// Searches along axes and diagonals with decreasing steps. True when the vertex moved.
  bool improve(int vertex) {
    if (mobility_[vertex].kind == Mobility::Kind::kFixed) return false;
    const double edge = shortestEdge(vertex), before = worstAround(vertex);
    double best = before;
    for (double step = kFirstStep; step > kLastStep;) {
      const double worst = stepToBest(vertex, step * edge, kFarthest * edge, best);
      if (!(worst > best)) step /= 2;
      best = worst;
    }
    return best > before;
  }

  /// Moves the vertex by `length` in the direction in which the worst tetrahedron around it becomes
  /// best, at most to the distance `farthest` from its start. It stays if no direction improves on
  /// `worst`. Returns the new worst.
  double stepToBest(int vertex, double length, double farthest, double worst) {
    const Eigen::Vector3d from = mesh_.vertices[vertex];
    Eigen::Vector3d best = from;
    for (int code = 0; code < 27; ++code) {
      const Eigen::Vector3d direction = Eigen::Vector3i(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).cast<double>();
      mesh_.vertices[vertex] = constrain(vertex, from + length * direction.normalized());
      if ((mesh_.vertices[vertex] - start_[vertex]).norm() > farthest) continue;
      const double quality = worstAround(vertex);
      if (quality > worst) {
        worst = quality;
        best = mesh_.vertices[vertex];
      }
    }
    mesh_.vertices[vertex] = best;
    return worst;
  }

  Eigen::Vector3d constrain(int vertex, const Eigen::Vector3d& point) const {
    const Mobility& mobility = mobility_[vertex];
    return mobility.kind == Mobility::Kind::kOnSphere ? mobility.radius * point.normalized() : point;
  }

  TetMesh& mesh_;
  const std::vector<Mobility>& mobility_;
  const double target_;
  const std::vector<Eigen::Vector3d> start_;
  std::vector<std::vector<int>> around_;     // tetrahedra of each vertex
  std::vector<std::pair<double, int>> bad_;  // quality at the start, tetrahedron
};

}  // namespace

void improveWorstTetrahedra(TetMesh& mesh, const std::vector<Mobility>& mobility, double target) {
  Improver improver(mesh, mobility, target);
  for (int i = 0; i < kSweeps && improver.sweep(); ++i) continue;
}

}  // namespace microinjection
