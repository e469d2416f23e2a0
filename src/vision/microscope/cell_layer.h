#pragma once

#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/optics.h"
#include "vision/microscope/texture.h"

namespace microinjection {

/// Adds a cell to the image: the borders of its zona, ooplasm, polar body and nucleus, and its
/// texture. `focus` (m) is the world's y of the plane in focus. All of it lies in the cell's
/// equatorial plane.
void addCell(const CellScene& cell, double focus, const CameraView& view, const Optics& optics, Texture& texture,
             OpticalImage& image);

}  // namespace microinjection
