#pragma once

#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/model/scene.h"
#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/force_field.h"
#include "cell/surrogate/surface_shape.h"
#include "cell/surrogate/surrogate_plan.h"
#include "cell/surrogate/training_set.h"

namespace microinjection {

/// Prepared data of a cell under a tip: stored energy, force and surface as functions of the
/// contact point and the tip's displacement. The energy's gradient is the force except for its
/// dependence on the path.
struct SurrogateData {
  SurrogateRange range;
  EnergyExpansion energy;
  ForceField field;
  SurfaceShape surface;
  double median_error = 0;         ///< relative, of the fitted force against its samples
  double common_error = 0;         ///< same, exceeded by one of ten samples
  double largest_error = 0;        ///< same, of forces above a four-hundredth of the largest
  double energy_median_error = 0;  ///< of the energy alone; set by fit(), not stored
  double energy_common_error = 0;

  /// Fits the results of plan.rays. On the axis it uses forces of the section, elsewhere
  /// those of the fine mesh or corrected ones of the coarse mesh. Throws as TrainingSet::gather.
  static SurrogateData fit(const Scene& scene, const SurrogatePlan& plan, const std::vector<TrainingResult>& results);
  /// Same, without the surface, which the results need not have.
  static SurrogateData fitForces(const Scene& scene, const SurrogatePlan& plan,
                                 const std::vector<TrainingResult>& results);

  /// Changes to a unit of length and one of energy, given in the new ones.
  void changeUnits(double length, double energy);

  /// Stores the data without dimension. `planned`: range of the preparation; `range` is the part
  /// that was reached.
  void save(const Scene& scene, const SurrogateRange& planned, const std::string& path) const;
  /// Data of this scene, or of a similar one (see similarity.h), in `path`, prepared for a range. The
  /// state is kDamaged, too, for an invalid size, index or value.
  static CacheRead<SurrogateData> load(const Scene& scene, const SurrogateRange& range, const std::string& path);

 private:
  static SurrogateData fitted(const SurrogatePlan& plan, const TrainingSet& all);
};

/// Folder of a scene's data, and the file of the result in it; empty without a cache.
std::string surrogateFolder(const Scene& scene, const SurrogatePlan& plan);
std::string surrogateFile(const Scene& scene, const SurrogatePlan& plan);

}  // namespace microinjection
