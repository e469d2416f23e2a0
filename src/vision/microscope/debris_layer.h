#pragma once

#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/optics.h"

namespace microinjection {

/// Adds a speck of dust or an air bubble to the image. `focus` (m) is the world's y of the plane in
/// focus.
void addDebris(const Debris& debris, double focus, const CameraView& view, const Optics& optics, OpticalImage& image);

}  // namespace microinjection
