#pragma once

#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/model/scene.h"
#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/force_field.h"
#include "cell/surrogate/preparation.h"
#include "cell/surrogate/surface_shape.h"

namespace microinjection {

/// The off-line stage's result for a cell under a tip: stored energy, force and surface as functions of where the tip
/// touched and how it moved since. The energy's gradient is the force but for what depends on the tip's way.
struct SurrogateData {
  PreparationRange range;
  EnergyExpansion energy;
  ForceField field;
  SurfaceShape surface;
  double median_error = 0;         ///< relative, of the force against the samples it was fitted to
  double common_error = 0;         ///< same, that nine of ten samples have less than
  double largest_error = 0;        ///< same, where the force is above a four-hundredth of the largest
  double energy_median_error = 0;  ///< of the energy alone; after a fit only, it is not stored
  double energy_common_error = 0;

  /// Fits the results of preparation.rays: forces of the section on the axis, of the fine mesh where there are some,
  /// else of the coarse one, corrected. Throws std::runtime_error when the section has no solution.
  static SurrogateData fit(const Scene& scene, const Preparation& preparation,
                           const std::vector<TrainingResult>& results);

  /// `asked`: the range of the preparation; `range` is what of it was reached.
  void save(const Scene& scene, const PreparationRange& asked, const std::string& path) const;
  /// Of this scene in `path`, prepared for a range. Damaged as well when a size, an index or a value cannot be.
  static CacheRead<SurrogateData> load(const Scene& scene, const PreparationRange& range, const std::string& path);
};

/// Folder of a scene's data, and the file of the result in it; empty when no cache is kept.
std::string preparedFolder(const Scene& scene, const Preparation& preparation);
std::string preparedFile(const Scene& scene, const Preparation& preparation);

}  // namespace microinjection
