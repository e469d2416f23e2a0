#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cell/scene.h"
#include "surrogate/energy_expansion.h"
#include "surrogate/preparation.h"
#include "surrogate/surface_shape.h"

namespace microinjection {

/// The off-line stage's result for a cell under a tip: stored energy and surface as functions of where the tip touched
/// and how it moved since. Force is the energy's gradient, so that no closed path in a contact creates energy.
struct PreparedCell {
  PreparationRange range;
  EnergyExpansion energy;
  SurfaceShape surface;
  double median_error = 0;   ///< relative, of the force against the samples it was fitted to
  double largest_error = 0;  ///< same, where the force is above a hundredth of the largest

  /// Fits, after taking off what the training's mesh is wrong by on the axis (the section is solved for that).
  static PreparedCell fit(const Scene& scene, const Preparation& preparation, std::vector<TrainingSample> samples);

  void save(const Scene& scene, const std::string& path) const;
  /// Of this scene in `path`; nothing when there is none.
  static std::optional<PreparedCell> load(const Scene& scene, const PreparationRange& range, const std::string& path);
};

/// Mesh of the training, see scene_mesh.h: the coarsest. Its error
/// is measured on the axis, where the section is cheap, and taken off.
constexpr double kTrainingLevel = -1;

/// Folder of a scene's data, and the file of the result in it; empty when no cache is kept.
std::string preparedFolder(const Scene& scene, const Preparation& preparation);
std::string preparedFile(const Scene& scene, const Preparation& preparation);

}  // namespace microinjection
