#include "vision/segmentation_training/specimen_effects.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vision/segmentation/pixel_class.h"

namespace microinjection {
namespace {

constexpr double kUnseen = 0.05;  // of the light: what is darker behind a wall or a stop cannot be seen

cv::Mat maskOf(const cv::Mat& label, PixelClass value) { return label == static_cast<int>(value); }

cv::Mat softened(const cv::Mat& mask, double blur) {
  cv::Mat soft;
  mask.convertTo(soft, CV_32F, 1 / 255.);
  cv::GaussianBlur(soft, soft, cv::Size(0, 0), blur);
  return soft;
}

/// px, signed: positive inside the mask.
cv::Mat signedDistance(const cv::Mat& mask) {
  cv::Mat inside, outside;
  cv::distanceTransform(mask, inside, cv::DIST_L2, 5);
  cv::distanceTransform(255 - mask, outside, cv::DIST_L2, 5);
  return inside - outside;
}

/// Texture, and a lighter or darker grey, of what has a class.
void addTissue(RandomDraw& random, const cv::Mat& mask, double texture, double shade, cv::Mat& light) {
  if (cv::countNonZero(mask) == 0) return;
  const double fine = random.within(0.4, 2.5);
  cv::Mat change = bandNoise(random, light.size(), fine, fine * random.within(1.5, 4)) * random.within(0, texture);
  if (random.chance(0.4)) {  // single grains that stand out
    cv::Mat grains;
    cv::max(change, 0, grains);
    change = grains * (random.chance(0.6) ? -2.5 : 2.5);
  }
  change += random.within(-shade, shade);
  light = light.mul(1 + change.mul(softened(mask, random.within(0.6, 1.5))));
}

/// A bright or dark band along a border, on either side.
void addBand(RandomDraw& random, const cv::Mat& distance, double strength, double widest, cv::Mat& light) {
  const double width = random.within(0.5, widest), place = random.within(-1.5, 1.5) * width;
  cv::Mat band = (distance - place) / width;
  band = -0.5 * band.mul(band);
  cv::exp(band, band);
  light = light.mul(1 + random.within(-strength, strength) * band);
}

void addTissues(RandomDraw& random, const cv::Mat& label, cv::Mat& light) {
  const cv::Mat ooplasm = maskOf(label, PixelClass::kOoplasm), zona = maskOf(label, PixelClass::kZona);
  if (random.chance(0.7)) addTissue(random, ooplasm, 0.25, 0.15, light);
  if (random.chance(0.5)) addTissue(random, zona, 0.1, 0.12, light);
  if (random.chance(0.3)) addTissue(random, maskOf(label, PixelClass::kPerivitellineSpace), 0.04, 0.1, light);
  if (random.chance(0.4)) addTissue(random, maskOf(label, PixelClass::kPolarBody), 0.15, 0.25, light);
  if (random.chance(0.3)) addTissue(random, maskOf(label, PixelClass::kHoldingPipette), 0.05, 0.3, light);
  if (random.chance(0.3)) addTissue(random, maskOf(label, PixelClass::kBoreMedium), 0.03, 0.3, light);
  if (random.chance(0.4)) addTissue(random, maskOf(label, PixelClass::kDebris), 0.2, 0.4, light);
  if (random.chance(0.5)) addTissue(random, maskOf(label, PixelClass::kBackground), 0.05, 0, light);
  if (random.chance(0.4)) addTissue(random, cv::Mat(label.size(), CV_8U, cv::Scalar(255)), 0.04, 0, light);
}

void addBands(RandomDraw& random, const cv::Mat& label, cv::Mat& light) {
  const cv::Mat ooplasm = maskOf(label, PixelClass::kOoplasm);
  const cv::Mat cell = ooplasm | maskOf(label, PixelClass::kZona) | maskOf(label, PixelClass::kPerivitellineSpace) |
                       maskOf(label, PixelClass::kPolarBody);
  if (cv::countNonZero(ooplasm) > 0 && random.chance(0.6)) {
    const cv::Mat distance = signedDistance(ooplasm);
    for (int i = 1 + random.upTo(2); i > 0; --i) addBand(random, distance, 0.6, 3, light);
  }
  if (cv::countNonZero(cell) > 0 && random.chance(0.5)) {
    const cv::Mat distance = signedDistance(cell);
    for (int i = random.upTo(2); i > 0; --i) addBand(random, distance, 0.4, 2.5, light);
    if (random.chance(0.4)) addBand(random, distance, 0.3, 10, light);
  }
  const cv::Mat needle = maskOf(label, PixelClass::kInjectionPipette);
  if (cv::countNonZero(needle) > 0 && random.chance(0.4)) {
    const cv::Mat distance = signedDistance(needle);
    addBand(random, distance, 0.4, 3, light);
    if (random.chance(0.4)) addBand(random, distance, 0.2, 10, light);
  }
}

/// Distance (px) of each pixel inside a large circle whose edge crosses the image.
cv::Mat insideLargeCircle(RandomDraw& random, const cv::Size& size) {
  const double diagonal = std::hypot(size.width, size.height);
  const double radius = diagonal * random.within(0.35, 3), angle = random.within(-M_PI, M_PI);
  const double x = random.within(0.05, 0.95) * size.width, y = random.within(0.05, 0.95) * size.height;
  const double cx = x + radius * std::cos(angle), cy = y + radius * std::sin(angle);
  cv::Mat inside(size, CV_32F);
  for (int row = 0; row < size.height; ++row)
    for (int column = 0; column < size.width; ++column)
      inside.at<float>(row, column) = static_cast<float>(radius - std::hypot(column - cx, row - cy));
  return inside;
}

cv::Mat softStep(const cv::Mat& distance, double softness) {
  cv::Mat step = distance / -softness;
  cv::exp(cv::min(step, 30), step);
  return 1 / (1 + step);
}

/// The dark, blurred wall of a well or drop, which hides what is behind it.
void addWell(RandomDraw& random, cv::Mat& light, cv::Mat& label) {
  const cv::Mat inside = insideLargeCircle(random, light.size());
  const double diagonal = std::hypot(light.cols, light.rows), softest = 0.12 * diagonal;
  cv::Mat dark = softStep(inside, random.within(0.6, softest));
  if (random.chance(0.6))
    dark = dark.mul(1 - softStep(inside - random.within(0.05, 0.5) * diagonal, random.within(0.6, softest)));
  const cv::Mat share = 1 - dark * random.within(0.3, 0.99);
  light = light.mul(share);
  label.setTo(static_cast<int>(PixelClass::kBackground), share < kUnseen);
}

void addFieldStop(RandomDraw& random, cv::Mat& light, cv::Mat& label) {
  const double radius = random.within(0.45, 1.1) * std::min(light.cols, light.rows) / (random.chance(0.5) ? 1 : 1.6);
  const double cx = random.within(0.35, 0.65) * light.cols, cy = random.within(0.35, 0.65) * light.rows;
  cv::Mat inside(light.size(), CV_32F);
  for (int y = 0; y < light.rows; ++y)
    for (int x = 0; x < light.cols; ++x)
      inside.at<float>(y, x) = static_cast<float>(radius - std::hypot(x - cx, y - cy));
  const cv::Mat share = softStep(inside, random.within(0.4, 4));
  light = light.mul(share);
  label.setTo(static_cast<int>(PixelClass::kBackground), share < kUnseen);
}

void addUnevenLight(RandomDraw& random, cv::Mat& light) {
  const double steep = random.chance(0.3) ? 0.8 : 0.2;
  const double right = random.within(-steep, steep), down = random.within(-steep, steep);
  const double fall = random.chance(0.4) ? random.within(0, 0.7) : 0;
  const double cx = random.within(-0.2, 0.2), cy = random.within(-0.2, 0.2);
  for (int y = 0; y < light.rows; ++y) {
    float* row = light.ptr<float>(y);
    const double v = (y + 0.5) / light.rows - 0.5;
    for (int x = 0; x < light.cols; ++x) {
      const double u = (x + 0.5) / light.cols - 0.5;
      const double lit = (1 + right * u + down * v) * (1 - fall * 2 * ((u - cx) * (u - cx) + (v - cy) * (v - cy)));
      row[x] *= static_cast<float>(std::max(0.0, lit));
    }
  }
}

/// Scratches, fibres and the edges of other things.
void addLines(RandomDraw& random, cv::Mat& light) {
  cv::Mat drawn(light.size(), CV_32F, cv::Scalar(0));
  for (int i = 1 + random.upTo(2); i > 0; --i) {
    cv::Point2d place(random.within(0, light.cols), random.within(0, light.rows));
    double angle = random.within(-M_PI, M_PI), bend = random.within(-0.15, 0.15);
    std::vector<cv::Point> points;
    for (int k = 4 + random.upTo(40); k > 0; --k) {
      points.emplace_back(place);
      place += 8 * cv::Point2d(std::cos(angle), std::sin(angle));
      angle += bend + random.within(-0.2, 0.2);
    }
    cv::polylines(drawn, points, false, random.within(-0.4, 0.4), 1 + random.upTo(2), cv::LINE_8);
  }
  cv::GaussianBlur(drawn, drawn, cv::Size(0, 0), random.within(0.5, 2.5));
  light = light.mul(1 + drawn);
}

}  // namespace

cv::Mat bandNoise(RandomDraw& random, const cv::Size& size, double fine, double coarse) {
  cv::Mat noise(size, CV_32F), low;
  cv::RNG source(random.bits());
  source.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::GaussianBlur(noise, low, cv::Size(0, 0), coarse);
  cv::GaussianBlur(noise, noise, cv::Size(0, 0), fine);
  noise -= low;
  return noise / (std::sqrt(cv::mean(noise.mul(noise))[0]) + 1e-9);
}

void addSpecimenEffects(RandomDraw& random, cv::Mat& light, cv::Mat& label) {
  addTissues(random, label, light);
  addBands(random, label, light);
  if (random.chance(0.12)) addLines(random, light);
  addUnevenLight(random, light);
  if (random.chance(0.28)) addWell(random, light, label);
  if (random.chance(0.08)) addFieldStop(random, light, label);
}

}  // namespace microinjection
