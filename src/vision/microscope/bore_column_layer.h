#pragma once

#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/optics.h"
#include "vision/microscope/texture.h"

namespace microinjection {

/// Adds what the pipette has drawn in to an image that has the pipette: granules between the mouth and the cap, and
/// the border at the cap, both within the bore. Changes nothing where the bore is empty. What the glass refracts of
/// it, which makes a column look thinner or wider, is left out. `focus` (m) is the world's y of the plane in focus.
void addBoreColumn(const InjectionPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                   Texture& texture, OpticalImage& image);

}  // namespace microinjection
