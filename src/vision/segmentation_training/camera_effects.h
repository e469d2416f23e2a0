#pragma once

#include <opencv2/core/mat.hpp>

#include "vision/microscope/random_draw.h"

namespace microinjection {

/// Makes of a picture (CV_32F, share of the light) what cameras, recorders and authors make of it: blur, squeezed
/// aspect ratio, exposure, gamma, inversion, noise, interlacing, compression, text, scale bars, frames, crosshairs,
/// contours. Returns CV_8U. `label` (CV_8U, PixelClass) gets the same geometry, and the burnt-in marks.
cv::Mat photograph(RandomDraw& random, const cv::Mat& light, cv::Mat& label);

}  // namespace microinjection
