#pragma once

#include <opencv2/core/mat.hpp>

#include "vision/camera/camera_view.h"
#include "vision/microscope/microscope_scene.h"
#include "vision/segmentation/pixel_class.h"

namespace microinjection {

/// Returns the PixelClass of each pixel of a rendered scene, CV_8U of the camera's size. Of two things at one place it
/// is the one that is rendered later; glass does not hide a cell in the bore. Focus and light change nothing. Debris
/// that is smaller than a pixel has no label.
cv::Mat labelImage(const MicroscopeScene& scene, const CameraView& view);

/// Gives `value` to the pixels inside an outline (m, in the world).
void fillOutline(const CellOutline& outline, const CameraView& view, PixelClass value, cv::Mat& label);

}  // namespace microinjection
