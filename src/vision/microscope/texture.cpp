#include "vision/microscope/texture.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr int kSide = 512;              // tile pixels
constexpr double kTilePixel = 0.25e-6;  // m
constexpr std::uint64_t kTileSeed = 20;
constexpr double kBlurStep = 0.12;  // relative, between blurs
constexpr double kLeastBlur = 0.3;  // tile pixels; less changes nothing

cv::Mat whiteNoise(std::uint64_t seed) {
  cv::Mat noise(kSide, kSide, CV_32F);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  return noise;
}

/// Noise with structures between two sizes (tile pixels), of zero mean and unit rms.
cv::Mat band(std::uint64_t seed, double fine, double coarse) {
  const cv::Mat noise = whiteNoise(seed);
  const cv::Mat result = blurPeriodic(noise, fine) - blurPeriodic(noise, coarse);
  return result / std::sqrt(cv::mean(result.mul(result))[0]);
}

}  // namespace

cv::Mat blurPeriodic(const cv::Mat& tile, double blur) {
  if (blur < kLeastBlur) return tile.clone();
  const int margin = std::min(tile.cols, 2 * static_cast<int>(std::ceil(2 * blur)) + 2);
  cv::Mat wide;
  cv::copyMakeBorder(tile, wide, margin, margin, margin, margin, cv::BORDER_WRAP);
  cv::GaussianBlur(wide, wide, cv::Size(0, 0), blur);
  return wide(cv::Rect(margin, margin, tile.cols, tile.rows)).clone();
}

Texture::Texture() {
  // Granules of about 1 um, clusters of some micrometres, and faint clouds.
  cv::Mat granules = band(kTileSeed, 1.5, 3.5);
  // Granules stand out of the noise: large values grow.
  granules = granules.mul(0.6 + 0.4 * cv::abs(granules));
  tile_ = 0.8 * granules + 0.5 * band(kTileSeed + 1, 3.5, 8) + 0.35 * band(kTileSeed + 2, 10, 30);
  tile_ /= std::sqrt(cv::mean(tile_.mul(tile_))[0]);
}

const cv::Mat& Texture::blurredTile(double blur) {
  const int step = static_cast<int>(std::lround(std::log(std::max(blur, kLeastBlur)) / std::log1p(kBlurStep)));
  auto found = blurred_.find(step);
  if (found == blurred_.end())
    found = blurred_.emplace(step, blurPeriodic(tile_, std::exp(step * std::log1p(kBlurStep)))).first;
  return found->second;
}

cv::Mat Texture::sample(const CameraView& view, const cv::Rect& region, const Eigen::Vector2d& material,
                        std::uint64_t seed, double blur) {
  const cv::Mat& tile = blurredTile(std::min(blur * view.pixel_size / kTilePixel, kSide / 4.0));
  // Image pixel -> world -> material -> tile pixel.
  const Eigen::Matrix2d turn = view.pixelsPerMetre().transpose() * (view.pixel_size * view.pixel_size) / kTilePixel;
  const Eigen::Vector2d place(static_cast<double>(seed * 211 % kSide), static_cast<double>(seed * 337 % kSide));
  const Eigen::Vector2d corner(region.x, region.y);
  const Eigen::Vector2d start = (view.worldOf(corner) - material) / kTilePixel + place;
  const cv::Matx23d map(turn(0, 0), turn(0, 1), start.x(), turn(1, 0), turn(1, 1), start.y());
  cv::Mat sampled;
  cv::warpAffine(tile, sampled, map, region.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_WRAP);
  return sampled;
}

}  // namespace microinjection
