#pragma once

#include <optional>
#include <string>

#include "operation/console/light.h"
#include "operation/console/session_view.h"

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

}  // namespace microinjection
