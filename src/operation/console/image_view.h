#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Which part of an image a widget shows, and where. Places in the image are in px: the centre of the
/// top-left pixel is 0, x is right, y down. Places in the widget are in px from its top-left corner.
/// The image never leaves the widget: what fits is centred, what does not covers it.
class ImageView {
 public:
  static constexpr double kLargestScale = 8;  ///< px of the widget per px of the image

  /// Sizes in px. An image of another size is shown whole.
  void setWidget(int width, int height);
  void setImage(int width, int height);

  void showAll();
  /// Shows a square with this centre and side (px of the image), as large as it fits.
  void showSquare(const Eigen::Vector2d& centre, double side);
  /// Magnifies about a place of the widget, which keeps its place.
  void zoom(const Eigen::Vector2d& place, double factor);
  void pan(const Eigen::Vector2d& motion);  ///< px of the widget

  double scale() const { return scale_; }  ///< px of the widget per px of the image
  bool showsAll() const { return scale_ <= smallestScale(); }
  Eigen::Vector2d toWidget(const Eigen::Vector2d& pixel) const;
  Eigen::Vector2d toImage(const Eigen::Vector2d& place) const;
  bool contains(const Eigen::Vector2d& pixel) const;  ///< the image has it

 private:
  double smallestScale() const;
  void setScale(double scale);
  void clamp();

  Eigen::Vector2d widget_ = Eigen::Vector2d::Ones(), image_ = Eigen::Vector2d::Ones();
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();  ///< px of the image, in the widget's middle
  double scale_ = 1;
};

}  // namespace microinjection
