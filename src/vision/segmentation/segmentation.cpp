#include "vision/segmentation/segmentation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace microinjection {
namespace {

constexpr int kLeastPixels = 4;  // of a region

/// The pixels of a mask and of the holes in it.
cv::Mat filled(const cv::Mat& mask) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::Mat whole(mask.size(), CV_8U, cv::Scalar(0));
  cv::drawContours(whole, contours, -1, 255, cv::FILLED);
  return whole;
}

/// The pixels that are in the frame by their middle.
cv::Rect outputRegion(const cv::Rect& working) {
  const int left = (working.x + 1) / 2, top = (working.y + 1) / 2;
  const int right = (working.br().x - 1) / 2 + 1, bottom = (working.br().y - 1) / 2 + 1;
  return {left, top, std::max(1, right - left), std::max(1, bottom - top)};
}

}  // namespace

Segmentation::Segmentation(std::array<cv::Mat, kPixelClasses> probabilities, const WorkingImage& working,
                           const cv::Size& frame)
    : probabilities_(std::move(probabilities)),
      working_(working),
      frame_(frame),
      inside_(outputRegion(working.region) & cv::Rect(0, 0, kWidth, kHeight)),
      classes_(kHeight, kWidth, CV_8U, cv::Scalar(0)) {
  cv::Mat outside(kHeight, kWidth, CV_8U, cv::Scalar(255));
  outside(inside_).setTo(0);
  for (cv::Mat& plane : probabilities_) plane.setTo(0, outside);
  cv::Mat best = probabilities_[0].clone();
  for (std::size_t i = 1; i < kPixelClasses; ++i) {
    const cv::Mat better = probabilities_[i] > best;
    probabilities_[i].copyTo(best, better);
    classes_.setTo(static_cast<int>(i), better);
  }
}

const cv::Mat& Segmentation::probability(PixelClass pixel_class) const {
  return probabilities_[static_cast<std::size_t>(pixel_class)];
}

cv::Mat Segmentation::probability(std::initializer_list<PixelClass> classes) const {
  cv::Mat sum(kHeight, kWidth, CV_32F, cv::Scalar(0));
  for (const PixelClass one : classes) sum += probability(one);
  return sum;
}

cv::Mat Segmentation::mask(std::initializer_list<PixelClass> classes) const {
  cv::Mat result(kHeight, kWidth, CV_8U, cv::Scalar(0));
  for (const PixelClass one : classes) result |= classes_ == static_cast<int>(one);
  cv::Mat outside(result.size(), CV_8U, cv::Scalar(255));
  outside(inside_).setTo(0);
  result.setTo(0, outside);
  return result;
}

std::vector<ClassRegion> Segmentation::regions(std::initializer_list<PixelClass> classes, double least, double inside,
                                               int closing) const {
  const cv::Mat sum = probability(classes);
  cv::Mat seen = sum > inside;
  if (closing > 0) {
    const int width = 2 * closing + 1;
    cv::morphologyEx(seen, seen, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width, width}));
  }
  cv::Mat components, statistics, centroids;
  const int count = cv::connectedComponentsWithStats(seen, components, statistics, centroids, 4, CV_32S);
  std::vector<ClassRegion> found;
  for (int i = 1; i < count; ++i) {
    if (statistics.at<int>(i, cv::CC_STAT_AREA) < kLeastPixels) continue;
    ClassRegion region = regionOf(components == i, sum);
    if (region.area >= least) found.push_back(std::move(region));
  }
  std::sort(found.begin(), found.end(), [](const ClassRegion& a, const ClassRegion& b) { return a.area > b.area; });
  return found;
}

std::optional<ClassRegion> Segmentation::largestRegion(std::initializer_list<PixelClass> classes) const {
  std::vector<ClassRegion> found = regions(classes);
  if (found.empty()) return std::nullopt;
  return std::move(found.front());
}

/// The share of a pixel is 1 inside, and its probability along the border and just outside.
ClassRegion Segmentation::regionOf(const cv::Mat& component, const cv::Mat& probability) const {
  ClassRegion region;
  region.mask = filled(component);
  cv::Mat inner, outer, share = probability.clone();
  cv::erode(region.mask, inner, cv::Mat());
  cv::dilate(region.mask, outer, cv::Mat());
  share.setTo(1, inner);
  share.setTo(0, 255 - outer);
  const cv::Moments moments = cv::moments(share);
  const double pixel = framePixels();
  region.area = moments.m00 * pixel * pixel;
  region.diameter = 2 * std::sqrt(region.area / M_PI);
  region.centre = toFrame({moments.m10 / moments.m00, moments.m01 / moments.m00});
  const double xx = moments.mu20 / moments.m00, yy = moments.mu02 / moments.m00, xy = moments.mu11 / moments.m00;
  const double middle = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
  region.semi_major = 2 * std::sqrt(middle + spread) * pixel;
  region.semi_minor = 2 * std::sqrt(std::max(0.0, middle - spread)) * pixel;
  region.angle = std::atan2(2 * xy, xx - yy) / 2;
  if (region.angle < 0) region.angle += M_PI;
  region.probability = cv::mean(probability, component)[0];
  const cv::Rect box = cv::boundingRect(region.mask);
  region.touches_border =
      box.x <= inside_.x || box.y <= inside_.y || box.br().x >= inside_.br().x || box.br().y >= inside_.br().y;
  return region;
}

std::optional<RegionWay> Segmentation::wayOf(const ClassRegion& region) const {
  constexpr double kEnd = 1;      // output px along the axis whose middle is taken
  constexpr int kDirections = 3;  // improvements of the axis
  constexpr int kNearBorder = 5;  // output px: the network does not always see what the border cuts
  std::vector<cv::Point> pixels;
  cv::findNonZero(region.mask, pixels);
  cv::Point2d entry(0, 0), end(0, 0);
  int entering = 0, nearest = kNearBorder;
  const auto toBorder = [this](const cv::Point& pixel) {
    return std::min(
        {pixel.x - inside_.x, pixel.y - inside_.y, inside_.br().x - 1 - pixel.x, inside_.br().y - 1 - pixel.y});
  };
  for (const cv::Point& pixel : pixels) nearest = std::min(nearest, toBorder(pixel));
  for (const cv::Point& pixel : pixels) {
    end += cv::Point2d(pixel);
    if (toBorder(pixel) > nearest || nearest >= kNearBorder) continue;
    entry += cv::Point2d(pixel);
    ++entering;
  }
  if (entering == 0) return std::nullopt;
  entry /= entering;
  end /= static_cast<double>(pixels.size());
  for (int i = 0; i < kDirections; ++i) {
    const cv::Point2d axis = end - entry;
    double farthest = 0;
    for (const cv::Point& pixel : pixels) farthest = std::max(farthest, (cv::Point2d(pixel) - entry).dot(axis));
    const double least = farthest - kEnd * cv::norm(axis);
    cv::Point2d sum(0, 0);
    int count = 0;
    for (const cv::Point& pixel : pixels) {
      if ((cv::Point2d(pixel) - entry).dot(axis) < least) continue;
      sum += cv::Point2d(pixel);
      ++count;
    }
    end = sum / count;
  }
  return RegionWay{toFrame(entry), toFrame(end)};
}

// An output pixel lies in the middle of 2 x 2 pixels of the working image.
cv::Point2d Segmentation::toFrame(const cv::Point2d& output) const {
  return working_.toImage(2 * output + cv::Point2d(0.5, 0.5));
}

cv::Point2d Segmentation::fromFrame(const cv::Point2d& pixel) const {
  return (working_.fromImage(pixel) - cv::Point2d(0.5, 0.5)) / 2;
}

}  // namespace microinjection
