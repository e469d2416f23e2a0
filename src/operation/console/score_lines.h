#pragma once

#include <vector>

#include "operation/console/guard_margins.h"
#include "operation/control/training_score.h"

namespace microinjection {

/// A bar for each measure of a training session, that fills up to its reference:
/// "peak force", "1.20 of 1.60 uN". Green within the reference, yellow up to twice it, where the
/// measure earns fewer points, red beyond. A count that has to be reached is grey until it is.
std::vector<GuardMargin> scoreMargins(const TrainingScore& score, const TrainingTask& task);

/// What a session that ends now earns: "ended now: 83 of 100 points", or why there are none.
std::string scoreText(const TrainingScore& score);

}  // namespace microinjection
