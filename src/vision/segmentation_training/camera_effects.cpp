#include "vision/segmentation_training/camera_effects.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "vision/segmentation/pixel_class.h"

namespace microinjection {
namespace {

constexpr int kSampled = 17;  // of the pixels, for percentiles
constexpr int kBurntIn = static_cast<int>(PixelClass::kBurntIn);

/// The darkest and the lightest usual level, and the median.
struct Levels {
  float low, median, high;
};

Levels levelsOf(const cv::Mat& image) {
  std::vector<float> values;
  const float* data = image.ptr<float>();
  for (std::size_t i = 0; i < image.total(); i += kSampled) values.push_back(data[i]);
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  return {values[count / 100], values[count / 2], values[count - 1 - count / 100]};
}

void squeeze(RandomDraw& random, cv::Mat& image, cv::Mat& label) {
  const double factor = random.within(0.72, 1.3);
  const cv::Size size(static_cast<int>(image.cols * factor), image.rows);
  cv::resize(image, image, size, 0, 0, factor < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::resize(label, label, size, 0, 0, cv::INTER_NEAREST);
}

void blurByMotion(RandomDraw& random, cv::Mat& image) {
  const int length = 2 + random.upTo(5);
  const double angle = random.within(0, M_PI);
  cv::Mat kernel(2 * length + 1, 2 * length + 1, CV_32F, cv::Scalar(0));
  const cv::Point2d way(length / 2.0 * std::cos(angle), length / 2.0 * std::sin(angle));
  const cv::Point2d middle(length, length);
  cv::line(kernel, middle - way, middle + way, 1, 1);
  cv::filter2D(image, image, CV_32F, kernel / cv::sum(kernel)[0], cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
}

void blur(RandomDraw& random, cv::Mat& image) {
  if (random.chance(0.4))
    cv::GaussianBlur(image, image, cv::Size(0, 0), random.within(0.3, random.chance(0.2) ? 2.5 : 1.2));
  if (random.chance(0.08)) blurByMotion(random, image);
  if (random.chance(0.1)) {
    const cv::Size size = image.size();
    cv::resize(image, image, size / 2, 0, 0, cv::INTER_AREA);
    cv::resize(image, image, size, 0, 0, cv::INTER_LINEAR);
  }
}

/// Every second row was recorded later.
void interlace(RandomDraw& random, cv::Mat& image) {
  const int by = random.upTo(6) - 3;
  for (int y = 1; y < image.rows; y += 2) {
    const cv::Mat row = image.row(y).clone();
    for (int x = 0; x < image.cols; ++x)
      image.at<float>(y, x) = row.at<float>(0, std::clamp(x + by, 0, image.cols - 1));
  }
}

/// To grey levels in [0, 1], over- or under-exposed now and then.
void expose(RandomDraw& random, cv::Mat& image) {
  const Levels levels = levelsOf(image);
  const float span = std::max(levels.high - levels.low, 0.02F);
  image = (image - levels.median) / span;
  const double contrast = random.chance(0.25) ? random.within(0.08, 0.4) : random.within(0.4, 1.1);
  const double gamma = std::exp(random.within(-0.8, 0.8));
  const double middle = random.within(0.2, 0.8);
  image = image * contrast + middle;
  cv::min(cv::max(image, 0), 1, image);
  cv::pow(image, gamma, image);
  if (random.chance(0.08)) image = 1 - image;
  if (random.chance(0.25)) {  // contrast about the median, cut at both ends
    const float median = levelsOf(image).median;
    image = (image - median) * random.within(0.3, 2) + median;
    cv::min(cv::max(image, 0), 1, image);
  }
}

void addNoise(RandomDraw& random, cv::Mat& image) {
  const Levels levels = levelsOf(image);
  const double strength = random.chance(0.2) ? random.within(0, 0.12) : random.within(0, 0.03);
  cv::Mat noise(image.size(), CV_32F);
  cv::RNG(random.bits()).fill(noise, cv::RNG::NORMAL, 0, strength * std::max(levels.high - levels.low, 0.05F));
  if (random.chance(0.3)) cv::GaussianBlur(noise * 2, noise, cv::Size(0, 0), random.within(0.4, 1));
  image += noise;
}

cv::Mat compressed(const cv::Mat& picture, int quality) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

std::string text(RandomDraw& random) {
  static const std::vector<std::string> words = {"50 um", "100 um", "10:42:07", "oocyte 12",  "x20",       "A",
                                                 "B",     "ICSI",   "MII",      "2026-03-14", "t = 3.5 s", "fig. 2"};
  return words[static_cast<std::size_t>(random.upTo(static_cast<int>(words.size()) - 1))];
}

/// Draws into the picture and, somewhat wider so that a coarse label has it, into the label.
class Marks {
 public:
  Marks(RandomDraw& random, cv::Mat& picture, cv::Mat& label) : random_(random), picture_(picture), label_(label) {
    level_ = random.chance(0.5) ? 255 : random.chance(0.6) ? 0 : random.upTo(255);
  }

  void addText() {
    const double size = random_.within(0.25, 0.8);
    const int thickness = size > 0.5 && random_.chance(0.5) ? 2 : 1;
    const cv::Point place(random_.upTo(picture_.cols * 3 / 4), 8 + random_.upTo(picture_.rows - 9));
    const std::string words = text(random_);
    int below = 0;
    const cv::Size box = cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, size, thickness, &below);
    cv::putText(picture_, words, place, cv::FONT_HERSHEY_SIMPLEX, size, level_, thickness, cv::LINE_AA);
    // The block of the text: single strokes are finer than a label.
    cv::rectangle(label_, cv::Rect(place - cv::Point(0, box.height), cv::Size(box.width, box.height + below / 2)),
                  kBurntIn, cv::FILLED);
  }

  void addScaleBar() {
    const int length = picture_.cols / 12 + random_.upTo(picture_.cols / 3), height = 1 + random_.upTo(5);
    const bool upright = random_.chance(0.15), low = random_.chance(0.7);
    const cv::Size size = upright ? cv::Size(height, length) : cv::Size(length, height);
    const cv::Point place(random_.upTo(std::max(1, picture_.cols - size.width)),
                          low ? picture_.rows - size.height - 2 - random_.upTo(picture_.rows / 5)
                              : random_.upTo(std::max(1, picture_.rows - size.height)));
    const cv::Rect bar(place, size);
    cv::rectangle(picture_, bar, level_, cv::FILLED);
    cv::rectangle(label_, bar, kBurntIn, cv::FILLED);
    if (height < 2) cv::rectangle(label_, bar, kBurntIn, 2);
  }

  void addFrame() {
    const int margin = random_.chance(0.5) ? random_.upTo(8) : random_.upTo(std::min(picture_.cols, picture_.rows) / 3);
    const cv::Rect frame(margin, margin, picture_.cols - 2 * margin, picture_.rows - 2 * margin);
    if (frame.width < 10 || frame.height < 10) return;
    const int thickness = 1 + random_.upTo(2);
    cv::rectangle(picture_, frame, level_, thickness);
    cv::rectangle(label_, frame, kBurntIn, thickness + 1);
  }

  void addCrosshair() {
    const cv::Point middle(picture_.cols / 2 + random_.upTo(20) - 10, picture_.rows / 2 + random_.upTo(20) - 10);
    const int arm = random_.chance(0.5) ? picture_.cols : 6 + random_.upTo(20);
    for (const cv::Point& way : {cv::Point(arm, 0), cv::Point(0, arm)}) {
      cv::line(picture_, middle - way, middle + way, level_, 1);
      cv::line(label_, middle - way, middle + way, kBurntIn, 2);
    }
  }

  /// The contour that somebody has drawn along a border; what is under it keeps its class.
  void addContours() {
    const int first = static_cast<int>(PixelClass::kZona), last = static_cast<int>(PixelClass::kPolarBody);
    for (int value = first + random_.upTo(1) * 2; value <= last; value += 1 + random_.upTo(2)) {
      const cv::Mat mask = (label_ >= value) & (label_ <= last);
      std::vector<std::vector<cv::Point>> contours;
      cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
      cv::drawContours(picture_, contours, -1, level_, 1 + random_.upTo(1));
    }
  }

 private:
  RandomDraw& random_;
  cv::Mat& picture_;
  cv::Mat& label_;
  int level_;
};

void addMarks(RandomDraw& random, cv::Mat& picture, cv::Mat& label) {
  if (random.chance(0.06)) Marks(random, picture, label).addContours();
  if (!random.chance(0.25)) return;
  Marks marks(random, picture, label);
  if (random.chance(0.5)) marks.addScaleBar();
  if (random.chance(0.2)) marks.addFrame();
  if (random.chance(0.15)) marks.addCrosshair();
  if (random.chance(0.6))
    for (int i = 1 + random.upTo(2); i > 0; --i) marks.addText();
}

void addSurround(RandomDraw& random, cv::Mat& picture, cv::Mat& label) {
  const int right = random.upTo(picture.cols / 4), below = random.upTo(picture.rows / 4);
  const int left = random.chance(0.5) ? random.upTo(picture.cols / 4) : 0;
  const int level = random.chance(0.7) ? 0 : 255;
  cv::copyMakeBorder(picture, picture, random.upTo(10), below, left, right, cv::BORDER_CONSTANT, level);
  const int top = picture.rows - label.rows - below;
  cv::copyMakeBorder(label, label, top, below, left, right, cv::BORDER_CONSTANT, 0);
}

}  // namespace

cv::Mat photograph(RandomDraw& random, const cv::Mat& light, cv::Mat& label) {
  cv::Mat image = light.clone();
  if (random.chance(0.4)) squeeze(random, image, label);
  blur(random, image);
  expose(random, image);
  if (random.chance(0.04)) interlace(random, image);
  addNoise(random, image);
  cv::Mat picture;
  image.convertTo(picture, CV_8U, 255);
  addMarks(random, picture, label);
  if (random.chance(0.05)) addSurround(random, picture, label);
  if (random.chance(0.35)) picture = compressed(picture, 20 + random.upTo(75));
  return picture;
}

}  // namespace microinjection
