#include "benchmark/common/image_transform.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr double kByte = 255;
constexpr std::uint64_t kNoiseSeed = 40;

/// The largest grey value of the camera: 255, or that of the bits which a 16-bit image uses.
double fullScale(const cv::Mat& image) {
  if (image.depth() == CV_8U) return kByte;
  double most = 0;
  cv::minMaxLoc(image.reshape(1), nullptr, &most);
  return std::exp2(std::ceil(std::log2(most + 1))) - 1;
}

/// The same with another image: one that is written into its matrix would be written into the original's.
MarkedImage withImage(const MarkedImage& original, const cv::Mat& image) {
  MarkedImage changed = original;
  changed.image = image;
  return changed;
}

/// Grey values of full scale 1 in all channels.
cv::Mat asFraction(const cv::Mat& image) {
  cv::Mat fraction;
  image.convertTo(fraction, CV_32F, 1 / fullScale(image));
  return fraction;
}

/// The image with other grey values (of full scale 1) of the same format.
MarkedImage withGrey(const MarkedImage& original, const cv::Mat& fraction) {
  cv::Mat image;
  cv::min(fraction, 1, image);
  image.convertTo(image, original.image.depth(), fullScale(original.image));
  return withImage(original, image);
}

MarkedImage withBytes(const MarkedImage& original, const cv::Mat& fraction) {
  cv::Mat image;
  fraction.convertTo(image, CV_8U, kByte);
  return withImage(original, image);
}

double medianOfImage(const cv::Mat& fraction) {
  std::vector<float> values(fraction.reshape(1, 1));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

MarkedImage unevenLight(const MarkedImage& original) {
  cv::Mat fraction = asFraction(original.image);
  const int channels = fraction.channels();
  for (int y = 0; y < fraction.rows; ++y) {
    float* row = fraction.ptr<float>(y);
    for (int i = 0; i < fraction.cols * channels; ++i) {
      const double x = static_cast<double>(i / channels) / fraction.cols;
      row[i] *= static_cast<float>(0.5 + 0.35 * x + 0.15 * y / fraction.rows);
    }
  }
  return withGrey(original, fraction);
}

MarkedImage contrast(const MarkedImage& original, double factor) {
  const cv::Mat fraction = asFraction(original.image);
  const double middle = medianOfImage(fraction);
  cv::Mat changed;
  fraction.convertTo(changed, CV_32F, factor, middle * (1 - factor));
  return withGrey(original, changed);
}

/// As 8 bits: a camera of more shows the dark ones as well.
MarkedImage darkened(const MarkedImage& original) { return withBytes(original, 0.6 * asFraction(original.image)); }

MarkedImage inverted(const MarkedImage& original) {
  cv::Mat changed;
  asFraction(original.image).convertTo(changed, CV_32F, -1, 1);
  MarkedImage result = withGrey(original, changed);
  result.contrast_mode = ContrastMode::kUnknown;  // there is no microscope that makes it
  return result;
}

/// Of a camera whose response is a square, underexposed and a little out of focus.
MarkedImage darkSquared(const MarkedImage& original) {
  double most = 0;
  cv::minMaxLoc(original.image.reshape(1), nullptr, &most);
  cv::Mat fraction;
  original.image.convertTo(fraction, CV_32F, 1 / most);
  cv::GaussianBlur(fraction, fraction, {0, 0}, 1.5);
  return withBytes(original, 0.8 * fraction.mul(fraction));
}

MarkedImage twelveBits(const MarkedImage& original) {
  cv::Mat image;
  asFraction(original.image).convertTo(image, CV_16U, 4095);
  return withImage(original, image);
}

MarkedImage compressed(const MarkedImage& original) {
  std::vector<unsigned char> file;
  cv::imencode(".jpg", withBytes(original, asFraction(original.image)).image, file, {cv::IMWRITE_JPEG_QUALITY, 30});
  return withImage(original, cv::imdecode(file, cv::IMREAD_UNCHANGED));
}

/// Moved by 5 px to the right during the exposure: the marks are where the middle of the motion is.
MarkedImage moving(const MarkedImage& original) {
  cv::Mat changed;
  cv::blur(asFraction(original.image), changed, {5, 1});
  return withGrey(original, changed);
}

/// @param deviation  grey levels of 256
MarkedImage noisy(const MarkedImage& original, double deviation) {
  cv::Mat fraction = asFraction(original.image), noise(fraction.size(), fraction.type());
  cv::RNG generator(kNoiseSeed);
  generator.fill(noise, cv::RNG::NORMAL, 0, deviation / kByte);
  return withGrey(original, fraction + noise);
}

/// With a scale bar and its length burnt in, which do not reach the border.
MarkedImage withScaleBar(const MarkedImage& original) {
  MarkedImage changed = withImage(original, original.image.clone());
  const int width = changed.image.cols / 8, height = std::max(3, changed.image.rows / 130), margin = 3 * height;
  const cv::Point corner(changed.image.cols - margin - width, changed.image.rows - margin - height);
  const cv::Scalar white = cv::Scalar::all(fullScale(original.image));
  cv::rectangle(changed.image, cv::Rect(corner, cv::Size(width, height)), white, cv::FILLED);
  cv::putText(changed.image, "50 um", corner - cv::Point(0, height), cv::FONT_HERSHEY_SIMPLEX, height / 8.0, white,
              std::max(1, height / 4), cv::LINE_AA);
  return changed;
}

double turnedBy(const cv::Matx23d& map, double direction) {
  const double c = std::cos(direction), s = std::sin(direction);
  return std::atan2(map(1, 0) * c + map(1, 1) * s, map(0, 0) * c + map(0, 1) * s);
}

/// The marks of an image whose points `map` has moved.
MarkedImage withMap(const MarkedImage& original, const cv::Matx23d& map, const cv::Mat& image) {
  MarkedImage changed = withImage(original, image);
  const double scale = std::sqrt(std::abs(map(0, 0) * map(1, 1) - map(0, 1) * map(1, 0)));
  changed.scale *= scale;
  changed.needle = turnedBy(map, original.needle);
  changed.holding = turnedBy(map, original.holding);
  const cv::Rect2d frame(-0.5, -0.5, image.cols, image.rows);
  for (ImageMark& mark : changed.marks) {
    const cv::Vec2d place = map * cv::Vec3d(mark.place.x, mark.place.y, 1);
    mark.place = {place[0], place[1]};
    mark.diameter *= scale;
    mark.tolerance *= scale;
    mark.in_frame = mark.in_frame && frame.contains(mark.place);
  }
  return changed;
}

/// About the image's middle. What comes in at the corners is the grey value of the border.
MarkedImage turned(const MarkedImage& original) {
  const cv::Point2d middle(0.5 * (original.image.cols - 1), 0.5 * (original.image.rows - 1));
  const double angle = 17 * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
  const cv::Matx23d map(c, -s, middle.x - c * middle.x + s * middle.y, s, c, middle.y - s * middle.x - c * middle.y);
  cv::Mat image;
  cv::warpAffine(original.image, image, map, original.image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return withMap(original, map, image);
}

MarkedImage mirrored(const MarkedImage& original) {
  cv::Mat image;
  cv::flip(original.image, image, 1);
  return withMap(original, {-1, 0, image.cols - 1.0, 0, 1, 0}, image);
}

MarkedImage resized(const MarkedImage& original, double factor, int interpolation) {
  cv::Mat image;
  cv::resize(original.image, image, {}, factor, factor, interpolation);
  const double x = static_cast<double>(image.cols) / original.image.cols;
  const double y = static_cast<double>(image.rows) / original.image.rows;
  return withMap(original, {x, 0, 0.5 * x - 0.5, 0, y, 0.5 * y - 0.5}, image);
}

}  // namespace

std::vector<ImageTransform> imageTransforms() {
  return {
      {"identity", [](const MarkedImage& image) { return image; }},
      {"uneven_light", unevenLight},
      {"turned_17", turned},
      {"mirrored", mirrored},
      {"half_size", [](const MarkedImage& image) { return resized(image, 0.5, cv::INTER_AREA); }},
      {"double_size", [](const MarkedImage& image) { return resized(image, 2, cv::INTER_CUBIC); }},
      {"contrast_1.5", [](const MarkedImage& image) { return contrast(image, 1.5); }},
      {"contrast_3", [](const MarkedImage& image) { return contrast(image, 3); }},
      {"darkened", darkened},
      {"twelve_bit", twelveBits},
      {"inverted", inverted},
      {"jpeg_30", compressed},
      {"motion_5", moving},
      {"noise_4", [](const MarkedImage& image) { return noisy(image, 4); }},
      {"noise_1", [](const MarkedImage& image) { return noisy(image, 1); }},
      {"dark_squared", darkSquared},
      {"scale_bar", withScaleBar},
  };
}

}  // namespace microinjection
