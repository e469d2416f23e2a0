#pragma once

#include <memory>
#include <string>

#include "cell/model/cell_tracker.h"
#include "cell/model/cell_under_needle.h"

namespace microinjection {

struct ServedCell {
  std::unique_ptr<CellUnderNeedle> cell;
  std::string said;         ///< which model it is, and why, for people
  bool as_required = true;  ///< else `said` is a warning
};

/// A scene's cell for a moving needle. `model`: prepared (what `prepare` left), live (see makeLiveCell) or auto (chosen
/// by the scene's requirements, see chooseModel; live where nothing is prepared). Never another than was asked for.
/// `path` of the scene, for messages. Throws ConfigError when the model cannot serve the scene.
ServedCell serveNeedle(const Scene& scene, const std::string& model, const CellTrackerConfig& config,
                       const std::string& path);

}  // namespace microinjection
