#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <opencv2/core/mat.hpp>

#include "vision/camera/camera_view.h"

namespace microinjection {

/// Granules of the cytoplasm: band-limited noise of zero mean and unit rms, fixed to the material of
/// the cell. One periodic tile of 128 um serves all cells; a cell's seed is its place in it.
class Texture {
 public:
  Texture();

  /// Returns the texture of the pixels of `region`, CV_32F. `material`: (x, z) (m) of the material's
  /// origin in the world; `blur`: px rms, of the image. Blurs are rounded to steps of 12 %, and the
  /// blurred tiles kept.
  cv::Mat sample(const CameraView& view, const cv::Rect& region, const Eigen::Vector2d& material, std::uint64_t seed,
                 double blur);

 private:
  const cv::Mat& blurredTile(double blur);

  cv::Mat tile_;                    ///< CV_32F
  std::map<int, cv::Mat> blurred_;  ///< by the step of the blur, of the tile's pixels
};

/// Blurs a periodic image. `blur`: px rms.
cv::Mat blurPeriodic(const cv::Mat& tile, double blur);

}  // namespace microinjection
