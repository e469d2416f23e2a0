#include "surrogate/training_ray.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "base/bytes.h"
#include "cell/cell_problem.h"
#include "cell/scene_mesh.h"
#include "surrogate/contact_place.h"

namespace microinjection {
namespace {

constexpr ElementKind kElement = ElementKind::kP2P0;

Scene at(const Scene& scene, double angle) {
  Scene result = Preparation::elastic(scene);
  result.needle.offset = ContactPlace::offsetFor(scene, angle);
  return result;
}

/// Nodes of the outer surface, ascending.
std::vector<int> surfaceNodes(const QuadraticMesh<3>& mesh) {
  std::vector<int> nodes;
  for (const auto& facet : mesh.facets) {
    if (facet.layer == 0) nodes.insert(nodes.end(), facet.nodes.begin(), facet.nodes.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// A ray in the plane of the place and the cell's axis leaves the scene its mirror symmetry.
bool inPlane(const TrainingRay& ray) { return ray.target.y() == 0; }

/// Displacement of the whole coarse mesh's surface, whether all of it or the half y >= 0 is solved.
class SurfaceOfState {
 public:
  SurfaceOfState(const Scene& there, const QuadraticMesh<3>& mesh, bool half) {
    const QuadraticMesh<3> whole = makeSceneMesh<3>(there, kCoarseLevel);
    const std::vector<int> candidates = surfaceNodes(mesh);
    for (int node : surfaceNodes(whole)) {
      Eigen::Vector3d x = whole.nodes[node];
      const bool other_side = half && x.y() < 0;
      if (other_side) x.y() *= -1;
      sides_.push_back(other_side ? -1.0f : 1.0f);
      nodes_.push_back(*std::min_element(candidates.begin(), candidates.end(), [&](int a, int b) {
        return (mesh.nodes[a] - x).squaredNorm() < (mesh.nodes[b] - x).squaredNorm();
      }));
    }
  }

  /// m, xyz of each node, ascending.
  Eigen::VectorXf displacement(const Eigen::VectorXd& state) const {
    Eigen::VectorXf result(3 * static_cast<Eigen::Index>(nodes_.size()));
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      result.segment<3>(3 * n) = state.segment<3>(3 * nodes_[n]).cast<float>();
      result[3 * n + 1] *= sides_[n];
    }
    return result;
  }

 private:
  std::vector<int> nodes_;    ///< of the state, for each of the whole surface
  std::vector<float> sides_;  ///< -1 where that is its mirror image
};

}  // namespace

TrainingResult solveRay(const Scene& scene, const TrainingRay& ray) {
  const Scene there = at(scene, ray.angle);
  const bool half = inPlane(ray);
  CellProblem<3> problem(there, half ? makeHalfSceneMesh(there, ray.level) : makeSceneMesh<3>(there, ray.level),
                         kElement, half ? Symmetry::kMirror : Symmetry::kNone);
  std::optional<SurfaceOfState> surface;
  if (ray.level == kCoarseLevel) surface.emplace(there, problem.body().mesh(), half);
  TrainingResult result;
  for (int i = 1; i <= ray.points; ++i) {
    const double share = static_cast<double>(i * i) / (ray.points * ray.points);
    const IndentationSolution solution = problem.solve(share * ray.target);
    if (!solution.converged) {
      result.reason = solution.reason;
      break;
    }
    result.samples.push_back({ray.angle, share * ray.target, solution.force, {}});
    if (surface) result.samples.back().surface = surface->displacement(problem.state());
  }
  return result;
}

std::string encode(const TrainingResult& result) {
  ByteWriter writer;
  writer.array(result.reason);
  writer.number<std::uint64_t>(result.samples.size());
  for (const TrainingSample& sample : result.samples) {
    writer.number(sample.angle);
    for (double x : sample.displacement) writer.number(x);
    for (double x : sample.force) writer.number(x);
    writer.array(sample.surface);
  }
  return writer.bytes();
}

TrainingResult decodeTraining(const std::string& bytes) {
  ByteReader reader(bytes);
  TrainingResult result;
  reader.array(result.reason);
  const auto count = reader.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    TrainingSample sample;
    sample.angle = reader.number<double>();
    for (double& x : sample.displacement) x = reader.number<double>();
    for (double& x : sample.force) x = reader.number<double>();
    reader.array(sample.surface);
    result.samples.push_back(std::move(sample));
  }
  return result;
}

TrainingSurface trainingSurface(const Scene& scene, double angle) {
  const QuadraticMesh<3> mesh = makeSceneMesh<3>(at(scene, angle), kCoarseLevel);
  const std::vector<int> nodes = surfaceNodes(mesh);
  std::map<int, int> index;
  TrainingSurface surface;
  surface.nodes.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    index[nodes[n]] = static_cast<int>(n);
    surface.nodes.segment<3>(3 * n) = mesh.nodes[nodes[n]];
  }
  for (const auto& facet : mesh.facets) {
    if (facet.layer != 0) continue;
    std::array<int, 6> f;
    std::transform(facet.nodes.begin(), facet.nodes.end(), f.begin(), [&](int node) { return index.at(node); });
    const int m01 = f[3], m12 = f[4], m20 = f[5];  // see elementEdges
    for (const Eigen::Vector3i& t : {Eigen::Vector3i(f[0], m01, m20), Eigen::Vector3i(m01, f[1], m12),
                                     Eigen::Vector3i(m20, m12, f[2]), Eigen::Vector3i(m01, m12, m20)}) {
      surface.triangles.push_back(t);
    }
  }
  return surface;
}

}  // namespace microinjection
