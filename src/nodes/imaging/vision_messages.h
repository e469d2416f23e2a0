#pragma once

#include <cell_microinjection/VisionState.h>

#include "vision/detection/specimen_tracker.h"

namespace microinjection {

/// The findings of a frame as a message, without header and time.
cell_microinjection::VisionState toMessage(const SpecimenView& view);

}  // namespace microinjection
