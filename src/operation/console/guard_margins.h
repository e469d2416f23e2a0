#pragma once

#include <optional>
#include <string>
#include <vector>

#include "operation/console/light.h"
#include "operation/console/session_view.h"
#include "operation/control/training_score.h"

namespace microinjection {

/// How near a guard is.
struct GuardMargin {
  std::string name;
  double share = 0;  ///< of the limit that is used, from 0; 1 and more: the guard acts
  Lamp lamp;         ///< yellow from kNear on, red from the limit on; grey: value or limit is not known
};

constexpr double kNear = 0.8;  ///< share of a limit from which its lamp is yellow

/// `value` and `limit` in SI units, shown in millionths of `unit`.
GuardMargin guardMargin(const std::string& name, std::optional<double> value, std::optional<double> limit,
                        const std::string& unit);

/// Guards of the force along the pipette and of the depth past the contact point.
GuardMargin forceMargin(const SessionView& session);
GuardMargin depthMargin(const SessionView& session);

/// A bar for each measure of a training session, that fills up to its reference:
/// "peak force", "1.20 of 1.60 uN". Green within the reference, yellow up to twice it, where the
/// measure earns fewer points, red beyond. A count that has to be reached is grey until it is.
std::vector<GuardMargin> scoreMargins(const TrainingScore& score, const TrainingTask& task);

/// What a session that ends now earns: "ended now: 83 of 100 points", or why there are none.
std::string scoreText(const TrainingScore& score);

}  // namespace microinjection
