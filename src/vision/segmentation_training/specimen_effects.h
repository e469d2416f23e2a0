#pragma once

#include <opencv2/core/mat.hpp>

#include "vision/microscope/random_draw.h"

namespace microinjection {

/// Changes a rendered picture (CV_32F, share of the light) so that learning does not rely on how the virtual microscope
/// renders: granules of every size, lighter and darker tissues, bands along borders, halos, uneven light, walls of
/// wells, scratches, the field stop. `label` (CV_8U, PixelClass) follows where something is no longer seen.
void addSpecimenEffects(RandomDraw& random, cv::Mat& light, cv::Mat& label);

/// Band-limited noise of zero mean and unit rms, CV_32F. `fine` and `coarse`: px rms, of the blurs.
cv::Mat bandNoise(RandomDraw& random, const cv::Size& size, double fine, double coarse);

}  // namespace microinjection
