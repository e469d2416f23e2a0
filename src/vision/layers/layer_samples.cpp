#include "vision/layers/layer_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vision/frame/polar_map.h"

namespace microinjection {
namespace {

constexpr double kRayDistance = 1.5;  // px, of neighbours on the ellipse
constexpr int kFewestRays = 5;        // of a sector

}  // namespace

LayerSamples::LayerSamples(const Frame& frame, const Ellipse& base, double low, double high, int sectors)
    : base_(base), low_(low) {
  const int columns = static_cast<int>(high - low) + 1;
  const int rays = std::max(kFewestRays, static_cast<int>(M_PI * base.meanDiameter() / sectors / kRayDistance));
  const PolarMap map(frame, base, {low, low + columns - 1, columns, sectors * rays}, 0);
  std::vector<float> values(rays);
  grey_ = cv::Mat(sectors, columns, CV_32F, cv::Scalar(0));
  valid_ = cv::Mat(sectors, columns, CV_8U, cv::Scalar(255));
  for (int sector = 0; sector < sectors; ++sector) {
    radius_.push_back(base.radius(direction(sector)));
    for (int i = 0; i < columns; ++i) {
      for (int k = 0; k < rays; ++k) {
        // The sector's middle ray has its direction.
        const int ray = (sector * rays + k - rays / 2 + map.rays()) % map.rays();
        if (map.valid().at<unsigned char>(ray, i) == 0) valid_.at<unsigned char>(sector, i) = 0;
        values[k] = map.grey().at<float>(ray, i);
      }
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      const float sum = std::accumulate(values.begin(), values.end(), 0.0F) - *least - *most;
      grey_.at<float>(sector, i) = sum / static_cast<float>(rays - 2);
    }
  }
}

double LayerSamples::direction(int sector) const { return 2 * M_PI * sector / sectors(); }

}  // namespace microinjection
