#include "surrogate/training_ray.h"

#include <cstdint>

#include "base/bytes.h"
#include "cell/cell_problem.h"
#include "cell/contact_place.h"
#include "cell/scene_mesh.h"
#include "mesh/outer_surface.h"

namespace microinjection {
namespace {

constexpr ElementKind kElement = ElementKind::kP2P0;

Scene at(const Scene& scene, double angle) {
  Scene result = Preparation::elastic(scene);
  result.needle.offset = ContactPlace::offsetFor(scene, angle);
  return result;
}

}  // namespace

TrainingResult solveRay(const Scene& scene, const TrainingRay& ray, double level) {
  const Scene there = at(scene, ray.angle);
  CellProblem<3> problem(there, makeSceneMesh<3>(there, level), kElement);
  const std::vector<int> nodes = outerNodes(problem.body().mesh());
  TrainingResult result;
  for (int i = 1; i <= ray.points; ++i) {
    const double share = static_cast<double>(i * i) / (ray.points * ray.points);
    const IndentationSolution solution = problem.solve(share * ray.target);
    if (!solution.converged) {
      result.reason = solution.reason;
      break;
    }
    TrainingSample sample{ray.angle, share * ray.target, solution.force, solution.stiffness, {}};
    sample.surface.resize(3 * static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      sample.surface.segment<3>(3 * n) = problem.state().segment<3>(3 * nodes[n]).cast<float>();
    }
    result.samples.push_back(std::move(sample));
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
    for (double x : sample.stiffness.reshaped()) writer.number(x);
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
    for (double& x : sample.stiffness.reshaped()) x = reader.number<double>();
    reader.array(sample.surface);
    result.samples.push_back(std::move(sample));
  }
  return result;
}

TrainingSurface trainingSurface(const Scene& scene, double angle, double level) {
  const QuadraticMesh<3> mesh = makeSceneMesh<3>(at(scene, angle), level);
  const std::vector<int> nodes = outerNodes(mesh);
  TrainingSurface surface;
  surface.nodes.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n) surface.nodes.segment<3>(3 * n) = mesh.nodes[nodes[n]];
  surface.triangles = outerTriangles(mesh);
  return surface;
}

}  // namespace microinjection
