#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/surrogate/preparation.h"

namespace microinjection {

/// An equilibrium of the converging model, in the frame of the place of contact.
struct TrainingSample {
  double angle = 0;                                        ///< rad, of the place
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, of the tip since it touched
  Eigen::Vector3d force = Eigen::Vector3d::Zero();         ///< N, of the cell on the needle
  Eigen::VectorXf surface;  ///< m, xyz of each node of the outer surface; coarse mesh only
};

struct TrainingResult {
  std::vector<TrainingSample> samples;  ///< in order along the ray
  std::string reason;                   ///< why the ray ended before its target; else empty
};

/// Solves along a ray, on P2-P0 elements in space. Throws as CellProblem.
TrainingResult solveRay(const Scene& scene, const TrainingRay& ray);

std::string encode(const TrainingResult& result);
/// Throws std::runtime_error when the bytes are not whole or hold a value that is not finite.
TrainingResult decodeTraining(const std::string& bytes);

/// The stored result of `ray`. Damaged as well when it is not of this ray, or when its surfaces are not of
/// `surface_size` numbers (trainingSurface().nodes.size()), as those of another mesh.
CacheRead<TrainingResult> loadTraining(const std::string& path, const std::string& description, const TrainingRay& ray,
                                       Eigen::Index surface_size);

/// The outer surface of the coarse meshes of solveRay with the needle's place at `angle`: all nodes, and triangles,
/// each facet cut into four, counter-clockwise seen from outside. Nodes of different angles correspond.
struct TrainingSurface {
  Eigen::VectorXd nodes;  ///< m, xyz of each
  std::vector<Eigen::Vector3i> triangles;
};
TrainingSurface trainingSurface(const Scene& scene, double angle);

}  // namespace microinjection
