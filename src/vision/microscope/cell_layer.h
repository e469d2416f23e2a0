#pragma once

#include <vector>

#include "vision/microscope/microscope_scene.h"
#include "vision/microscope/optics.h"
#include "vision/microscope/texture.h"

namespace microinjection {

/// How a body's border changes the light. `pixel_size`: m.
std::vector<BorderProfile::Step> borderSteps(const BodyOptics& body, double pixel_size);

/// Granules are phase objects: in DIC they show by their path, rad per contrast.
constexpr double kGranulePath = 3;
/// px rms. A cell is full of granules: however far the focus is, some are near it. `defocus`: m.
double granuleBlur(const Optics& optics, double defocus);

/// Adds a cell to the image: the borders of its zona, ooplasm, polar body and nucleus, and its
/// texture. `focus` (m) is the world's y of the plane in focus. All of it lies in the cell's
/// equatorial plane.
void addCell(const CellScene& cell, double focus, const CameraView& view, const Optics& optics, Texture& texture,
             OpticalImage& image);

}  // namespace microinjection
