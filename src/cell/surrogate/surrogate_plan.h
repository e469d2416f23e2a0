#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/energy_expansion.h"

namespace microinjection {

/// The range of a surrogate cell: a cylinder below each contact point, deeper on the cell's axis. Polynomials mean
/// nothing outside of the paths that they were fitted to, so the range is a part of the data, and a preparation shrinks
/// it to what has a solution.
///
///           contact point
///     --------+--------       surface at rest, at `angle` from the pole
///     |     / | \     |
///     |   /   |   \   |       paths: straight, from the contact point to the border
///     | /     |     \ |
///     +-------+-------+       `depth`
///             `lateral`
struct SurrogateRange {
  double angle = 0;       ///< rad, largest angle of the contact point from the pole
  double depth = 0;       ///< m, of the tip below the contact point
  double axis_depth = 0;  ///< m, same, for a contact point on the cell's axis
  double lateral = 0;     ///< m, of the tip, sideways

  /// Range for a training session: 60 degrees; 0.36, on the axis 0.805, and 0.09 of the cell's diameter. The depth on
  /// the axis reaches the paper's puncture, 45 um in a cell of 56 um. The section is solved there, because in space a
  /// coarse mesh has no equilibrium past 31 um (doc/design/surrogate_cell.md, What was tried).
  static SurrogateRange standard(const Scene& scene);

  /// The range of a cell that is larger by a factor.
  SurrogateRange scaled(double factor) const;
};

/// Meshes of the training, see scene_mesh.h. All paths are solved on the coarse mesh; some of those in a plane of
/// symmetry, where half of the mesh suffices, also on the fine one. The coarse force is up to 4 % off near the touch
/// and 1 % deeper, by a factor that varies smoothly, so MeshCorrection fits it to the paths with both meshes
/// (doc/design/surrogate_cell.md). A path out of the plane would cost some twenty times as much on the whole fine mesh
/// as one in the plane on the coarse half.
constexpr double kCoarseLevel = -1, kFineLevel = 0;

/// A straight path of the tip from first contact to the border of the range. Places inside of the range are reached on
/// one straight path each, which leaves out that a sticking tip's force depends on its path: down and then aside
/// instead, it differs by 0.3 to 2.7 % (doc/reference/benchmarks.md, A surrogate cell).
struct TrainingRay {
  double angle = 0;                                  ///< rad, of the contact point
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< m, displacement at its end, in the contact frame
  int points = 12;                                   ///< points along it, at the squares of equal steps
  double level = kCoarseLevel;                       ///< of the mesh

  /// Displacement at the point `index`, from 0, m.
  Eigen::Vector3d at(int index) const {
    return static_cast<double>((index + 1) * (index + 1)) / (points * points) * target;
  }
};

/// Which paths are solved. kFew: without those that change the fit least, where neighbours in a
/// family help each other: fine ones at two tilts only, and beside the plane of symmetry none at the
/// smallest angle.
enum class PathSet { kAll, kFew };

/// Plan of the computations for a surrogate cell. Each path is a process with a result of its own on disk, so that an
/// interrupted preparation goes on where it was; the mouse oocyte under a hemisphere has 46 paths, 20 of them on both
/// meshes (doc/design/surrogate_cell.md).
struct SurrogatePlan {
  SurrogateRange range;
  std::vector<TrainingRay> rays;  ///< most expensive first, so that workers end together
  EnergyScales scales;

  static SurrogatePlan plan(const Scene& scene, const SurrogateRange& range, PathSet paths = PathSet::kAll);

  /// All paths of a range, also those on which the tip would only graze the cell.
  static std::vector<TrainingRay> paths(const SurrogateRange& range, PathSet paths);

  /// Throws ConfigError for a scene whose force is not that of an elastic cell with ForceMemory:
  /// with friction, with layers that relax differently, or with a viscosity that does not relax. And
  /// for a sharp disc on a nonlinear cell, whose converged force ends within the range.
  static void check(const Scene& scene);

  /// The scene that is solved: without viscoelasticity.
  static Scene elastic(const Scene& scene);

  /// One line with scene, range and version of the data, without dimension: similar scenes have the
  /// same data (see similarity.h).
  std::string description(const Scene& scene) const;
  /// Same, for one path.
  std::string description(const Scene& scene, const TrainingRay& ray) const;
};

}  // namespace microinjection
