#include "cell/family/path_forces.h"

#include <cstdint>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr std::uint64_t kMostPaths = 1000;

}  // namespace

std::vector<PathForces> pathForces(const std::vector<TrainingResult>& results) {
  std::vector<PathForces> paths;
  for (const TrainingResult& result : results) {
    PathForces path;
    path.forces.resize(3, static_cast<Eigen::Index>(result.samples.size()));
    for (std::size_t i = 0; i < result.samples.size(); ++i) {
      path.forces.col(static_cast<Eigen::Index>(i)) = result.samples[i].force.cast<float>();
    }
    path.ended_early = !result.reason.empty();
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<TrainingResult> trainingResults(const SurrogatePlan& plan, const std::vector<PathForces>& paths) {
  if (paths.size() != plan.rays.size()) throw std::runtime_error("the paths are of another plan");
  std::vector<TrainingResult> results;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const TrainingRay& ray = plan.rays[i];
    if (paths[i].forces.cols() > ray.points) throw std::runtime_error("the paths are of another plan");
    TrainingResult result;
    for (int k = 0; k < paths[i].forces.cols(); ++k) {
      result.samples.push_back({ray.angle, ray.at(k), paths[i].forces.col(k).cast<double>(), {}});
    }
    if (paths[i].ended_early) result.reason = "the path ended early";
    results.push_back(std::move(result));
  }
  return results;
}

void write(ByteWriter& writer, const std::vector<PathForces>& paths) {
  writer.number<std::uint64_t>(paths.size());
  for (const PathForces& path : paths) {
    writer.number<std::uint8_t>(path.ended_early);
    writer.array(path.forces);
  }
}

std::vector<PathForces> readPathForces(ByteReader& reader) {
  const auto count = reader.number<std::uint64_t>();
  if (count > kMostPaths) throw std::runtime_error("a number of paths cannot be");
  std::vector<PathForces> paths;
  for (std::uint64_t i = 0; i < count; ++i) {
    PathForces path;
    path.ended_early = reader.number<std::uint8_t>() != 0;
    Eigen::VectorXf values;
    reader.array(values);
    if (values.size() % 3 != 0 || !values.allFinite()) throw std::runtime_error("the forces of a path cannot be");
    path.forces = Eigen::Map<const Eigen::Matrix3Xf>(values.data(), 3, values.size() / 3);
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace microinjection
