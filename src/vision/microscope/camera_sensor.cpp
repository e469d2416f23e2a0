#include "vision/microscope/camera_sensor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

namespace microinjection {
namespace {

constexpr std::size_t kNormals = std::size_t{1} << 21;
constexpr std::uint64_t kNormalSeed = 3;
constexpr std::uint64_t kMottleSeed = 4;
constexpr double kMottleSize = 4;  // px rms, of the blur
constexpr double kStopSoftness = 0.012;

cv::Mat mottleOf(const cv::Size& size) {
  cv::Mat noise(size, CV_32F);
  cv::RNG random(kMottleSeed);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::GaussianBlur(noise, noise, cv::Size(0, 0), kMottleSize);
  return noise / std::sqrt(cv::mean(noise.mul(noise))[0]);
}

/// Share of the light at a distance from the middle, over half the diagonal, that a field stop lets
/// through.
double behindStop(double distance, double stop) {
  return stop == 0 ? 1 : 1 / (1 + std::exp((distance - stop) / kStopSoftness));
}

cv::Mat illuminationOf(const MicroscopeConfig& config) {
  const IlluminationConfig& light = config.illumination;
  const double full = config.sensor.bits == 16 ? 65535 : 255;
  const int width = config.camera.width, height = config.camera.height;
  const double half = std::hypot(width, height) / 2;
  cv::Mat result = mottleOf(cv::Size(width, height)) * light.mottle + 1;
  for (int y = 0; y < height; ++y) {
    float* row = result.ptr<float>(y);
    const double v = (y - (height - 1) / 2.0) / height;
    for (int x = 0; x < width; ++x) {
      const double u = (x - (width - 1) / 2.0) / width;
      const double fall = light.vignetting * 2 * (u * u + v * v);
      const double lit = behindStop(std::hypot(u * width, v * height) / half, light.field_stop);
      const double slope = 1 + light.gradient.x() * u + light.gradient.y() * v;
      row[x] *= static_cast<float>(full * light.level * slope * (1 - fall) * lit);
    }
  }
  return result;
}

/// Rounds and cuts to the levels of the camera.
template <typename Level>
void exposeRow(const float* light, const float* transmission, const float* normal, int step, float sign, float variance,
               float read_variance, Level* row, int width) {
  for (int x = 0; x < width; ++x, normal += step) {
    const float level = light[x] * transmission[x];
    const float noise = sign * *normal * std::sqrt(std::max(0.0F, level) * variance + read_variance);
    row[x] = cv::saturate_cast<Level>(level + noise);
  }
}

}  // namespace

CameraSensor::CameraSensor(const MicroscopeConfig& config)
    : config_(config.sensor), illumination_(illuminationOf(config)) {
  cv::Mat normals(1, static_cast<int>(kNormals), CV_32F);
  cv::RNG random(kNormalSeed);
  random.fill(normals, cv::RNG::NORMAL, 0, 1);
  normals_.assign(normals.begin<float>(), normals.end<float>());
}

cv::Mat CameraSensor::expose(const cv::Mat& transmission, std::uint64_t seed) const {
  const int width = transmission.cols;
  cv::Mat picture(transmission.size(), config_.bits == 16 ? CV_16U : CV_8U);
  const auto variance = static_cast<float>(1 / config_.gain);
  const double read = config_.read_noise / config_.gain;
  const auto read_variance = static_cast<float>(read * read);
  std::mt19937_64 random(seed);
  for (int y = 0; y < picture.rows; ++y) {
    const std::uint64_t draw = random();
    const float sign = draw & 1 ? 1.0F : -1.0F;
    const bool backwards = draw & 2;
    const std::size_t place = (draw >> 8) % (kNormals - static_cast<std::size_t>(width));
    const float* normal = normals_.data() + place + (backwards ? width - 1 : 0);
    const int step = backwards ? -1 : 1;
    const float* light = illumination_.ptr<float>(y);
    const float* share = transmission.ptr<float>(y);
    if (config_.bits == 16) {
      exposeRow(light, share, normal, step, sign, variance, read_variance, picture.ptr<unsigned short>(y), width);
    } else {
      exposeRow(light, share, normal, step, sign, variance, read_variance, picture.ptr<unsigned char>(y), width);
    }
  }
  if (config_.jpeg_quality == 0) return picture;
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, config_.jpeg_quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

}  // namespace microinjection
