#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// Measured accuracy and speed of a model with one scene.
struct ModelFigures {
  std::string name;                                              ///< surrogate or live
  double force_error = std::numeric_limits<double>::infinity();  ///< relative, against the converged force
  double time = 0;                                               ///< s of CPU time for one force
};

struct ModelChoice {
  std::string name;
  bool meets = false;  ///< both requirements
  std::string reason;  ///< one line, with the figures of all models
};

/// The fastest of the models that meet both requirements. If none does, the most accurate of those
/// that are fast enough, else the fastest. `models` must not be empty.
ModelChoice chooseModel(const Scene::Requirements& requirements, std::vector<ModelFigures> models);

/// Solves the live cell (see makeLiveCell) at a few depths on the axis and compares it with the
/// converged section, where that has a solution. Takes seconds to a minute. Throws ConfigError when
/// there is no live cell for the scene.
ModelFigures measureLiveCell(const Scene& scene);

/// Error of the fit (nine of ten equilibria have less), and time measured now (99 of 100 steps take
/// less).
ModelFigures measureSurrogate(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell);

/// Stores figures with the scene's surrogate data, because a choice must not take a minute.
void saveFigures(const Scene& scene, const ModelFigures& figures);
CacheRead<ModelFigures> loadFigures(const Scene& scene, const std::string& name);

}  // namespace microinjection
