#include "operation/console/image_view.h"

#include <algorithm>

namespace microinjection {

void ImageView::setWidget(int width, int height) {
  const bool all = showsAll();
  widget_ = {std::max(1, width), std::max(1, height)};
  if (all) {
    showAll();
  } else {
    setScale(scale_);
  }
}

void ImageView::setImage(int width, int height) {
  const Eigen::Vector2d size(std::max(1, width), std::max(1, height));
  if (size == image_) return;
  image_ = size;
  showAll();
}

void ImageView::showAll() {
  scale_ = smallestScale();
  centre_ = (image_ - Eigen::Vector2d::Ones()) / 2;
}

void ImageView::showSquare(const Eigen::Vector2d& centre, double side) {
  centre_ = centre;
  setScale(widget_.minCoeff() / std::max(1.0, side));
}

void ImageView::zoom(const Eigen::Vector2d& place, double factor) {
  const Eigen::Vector2d kept = toImage(place);
  scale_ = std::clamp(scale_ * factor, smallestScale(), std::max(smallestScale(), kLargestScale));
  centre_ = kept - (place - widget_ / 2) / scale_;
  clamp();
}

void ImageView::pan(const Eigen::Vector2d& motion) {
  centre_ -= motion / scale_;
  clamp();
}

Eigen::Vector2d ImageView::toWidget(const Eigen::Vector2d& pixel) const {
  return (pixel - centre_) * scale_ + widget_ / 2;
}

Eigen::Vector2d ImageView::toImage(const Eigen::Vector2d& place) const {
  return (place - widget_ / 2) / scale_ + centre_;
}

bool ImageView::contains(const Eigen::Vector2d& pixel) const {
  return (pixel.array() >= -0.5).all() && (pixel.array() <= image_.array() - 0.5).all();
}

double ImageView::smallestScale() const { return (widget_.array() / image_.array()).minCoeff(); }

void ImageView::setScale(double scale) {
  scale_ = std::clamp(scale, smallestScale(), std::max(smallestScale(), kLargestScale));
  clamp();
}

void ImageView::clamp() {
  for (int i = 0; i < 2; ++i) {
    const double half = widget_[i] / scale_ / 2, low = half - 0.5, high = image_[i] - 0.5 - half;
    centre_[i] = low > high ? (image_[i] - 1) / 2 : std::clamp(centre_[i], low, high);
  }
}

}  // namespace microinjection
