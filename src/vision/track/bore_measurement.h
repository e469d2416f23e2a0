#pragma once

#include "vision/frame/contrast_mode.h"
#include "vision/track/specimen_view.h"

namespace microinjection {

/// Measures what is in the bores of a view's pipettes, and whether the cell is at the mouth. `mode`: of the
/// microscope. In phase and DIC a border has another look, and is uncertain.
void measureBores(const Frame& frame, ContrastMode mode, SpecimenView& view);

}  // namespace microinjection
