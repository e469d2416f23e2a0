#pragma once

#include <cell_microinjection/CellEstimate.h>
#include <cell_microinjection/PuncturePrediction.h>

#include <optional>

#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/puncture_prediction.h"

namespace microinjection {

/// All zero without a prediction.
cell_microinjection::PuncturePrediction toMessage(const std::optional<PuncturePrediction>& prediction);

/// Without header, prediction and what is served.
cell_microinjection::CellEstimate toMessage(const CellEstimate& estimate);

}  // namespace microinjection
