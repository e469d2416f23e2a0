#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// What was measured of a model that can serve a needle with one scene.
struct ModelFigures {
  std::string name;                                              ///< prepared or live
  double force_error = std::numeric_limits<double>::infinity();  ///< relative, against the converged force
  double time = 0;                                               ///< s of CPU for one force of its own
};

struct ModelChoice {
  std::string name;
  bool meets = false;  ///< both requirements
  std::string reason;  ///< one line, with the figures of all
};

/// The cheapest of the models that meet both requirements. Where none does: of those that are quick enough the one with
/// the smallest error; else the quickest. `models` must not be empty.
ModelChoice chooseModel(const Scene::Requirements& requirements, std::vector<ModelFigures> models);

/// Solves the live cell (see makeOnlineCell) to a few depths on the axis and compares with the converging section,
/// where that has a solution. Takes seconds to a minute. Throws ConfigError when there is no live cell for the scene.
ModelFigures measureLiveCell(const Scene& scene);

/// Error as found when it was fitted (nine of ten equilibria have less), time (99 of 100 steps take less) measured now.
ModelFigures measurePreparedCell(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell);

/// Kept where the scene's prepared data lie, for a choice that must not take a minute.
void saveFigures(const Scene& scene, const ModelFigures& figures);
CacheRead<ModelFigures> loadFigures(const Scene& scene, const std::string& name);

}  // namespace microinjection
