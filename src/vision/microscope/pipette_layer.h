#pragma once

#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/optics.h"

namespace microinjection {

/// Adds a pipette to the image: two walls, the bright core between them, the fringes of the glass
/// and the end face. An inclined injection pipette has its own defocus at each place of its axis.
/// `focus` (m) is the world's y of the plane in focus.
void addPipette(const HoldingPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image);
void addPipette(const InjectionPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image);

}  // namespace microinjection
