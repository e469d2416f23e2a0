#pragma once

#include <cell_microinjection/VisionState.h>

#include <limits>

#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// In place of a number that an image does not show.
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// The findings of a frame as a message, without header and time.
cell_microinjection::VisionState toMessage(const SpecimenView& view);

}  // namespace microinjection
