#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/energy_expansion.h"

namespace microinjection {

/// The range of a prepared cell.
struct PreparationRange {
  double angle = 0;       ///< rad, largest, of the place of contact from the pole
  double depth = 0;       ///< m, of the tip below where it touched
  double axis_depth = 0;  ///< m, same, where it touched on the cell's axis
  double lateral = 0;     ///< m, of the tip, sideways

  /// What a training room needs: 60 degrees; 0.36, on the axis 0.8, and 0.09 of the cell's diameter.
  static PreparationRange standard(const Scene& scene);
};

/// Meshes of the training, see scene_mesh.h. All paths are solved on the coarse one; those in a plane of symmetry,
/// where half of the mesh is enough, on the fine one as well.
constexpr double kCoarseLevel = -1, kFineLevel = 0;

/// A straight path of the tip from where it touches the cell to the border of the range.
struct TrainingRay {
  double angle = 0;                                  ///< rad, of the place of contact
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< m, displacement at its end, in the frame of the place
  int points = 12;                                   ///< places along it, at the squares of equal steps
  double level = kCoarseLevel;                       ///< of the mesh
};

/// What is computed for a prepared cell.
struct Preparation {
  PreparationRange range;
  std::vector<TrainingRay> rays;  ///< those that take longest first, so that workers end together
  EnergyScales scales;
  EnergyDegrees degrees;

  static Preparation plan(const Scene& scene, const PreparationRange& range);

  /// Throws ConfigError for a scene whose force is not that of an elastic cell with ForceMemory: rubbing, of layers
  /// that relax differently, or with a viscosity that does not relax.
  static void check(const Scene& scene);

  /// The scene whose equilibria are prepared: without viscoelasticity.
  static Scene elastic(const Scene& scene);

  /// One line that says of what scene and range, by which version, the data are.
  std::string description(const Scene& scene) const;
  /// Same, of one path.
  std::string description(const Scene& scene, const TrainingRay& ray) const;
};

}  // namespace microinjection
